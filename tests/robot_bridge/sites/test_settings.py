"""site.toml: what is written is read back, and each wrong value is named with its place."""

import pytest

from robot_bridge.sites.errors import SettingsError
from robot_bridge.sites.settings import Bounds, LivenessLimits, SiteSettings, read_settings, settings_text

SETTINGS = SiteSettings(
    id="yard-1",
    name='The "north" yard, č. 1',
    version=3,
    crs="EPSG:32633",
    origin=(640420.0, 5193480.5),
    bounds=Bounds(-10.0, 0.0, 200.0, 160.0),
    rotation_deg=12.5,
    reached_tolerance_m=0.1,
    liveness=LivenessLimits(2.0, 8.0),
)
TEXT = settings_text(SETTINGS)


@pytest.fixture
def read(tmp_path):
    """Return a function that reads a text as ``site.toml``."""

    def read_text(text):
        file = tmp_path / "site.toml"
        file.write_text(text, encoding="utf-8")
        return read_settings(file)

    return read_text


def test_settings_are_read_back_as_they_were_written(read):
    assert read(TEXT) == SETTINGS


def test_what_may_be_left_out_has_the_values_of_the_design(read):
    lines = [line for line in TEXT.splitlines() if not line.startswith(("rotation", "reached"))]
    settings = read("\n".join(lines).partition("[liveness]")[0])
    assert settings.rotation_deg == 0.0
    assert settings.reached_tolerance_m == 0.20
    assert (settings.liveness.stale_after_s, settings.liveness.lost_after_s) == (3.0, 10.0)


def replaced(key, value):
    return "\n".join(
        f"{key} = {value}" if line.startswith(f"{key} =") else line for line in TEXT.splitlines()
    )


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (replaced("origin", '["x", 2.0]'), "site.origin[0] = 'x': Expected `float`, got `str`"),
        (replaced("origin", "[1.0]"), "site.origin = [1.0]: Expected `array` of length 2"),
        (replaced("origin", "[nan, 2.0]"), "site.origin = [nan, 2.0]: nan and inf are no numbers for a site"),
        (replaced("bounds", "[0, 0, 10]"), "site.bounds = [0, 0, 10]: Expected `array` of length 4"),
        (replaced("bounds", "[0, 0, 0, 5]"), "site.bounds = [0.0, 0.0, 0.0, 5.0] has no area"),
        (replaced("version", "true"), "site.version = True: Expected `int`, got `bool`"),
        (replaced("version", "0"), "site.version = 0 is below 1"),
        (replaced("id", '"a b"'), "site.id = 'a b' is not an id: use letters"),
        (replaced("name", '" "'), "site.name = ' ' is empty"),
        (replaced("name", '"a\\nb"'), "has a line break"),
        (replaced("crs", '"EPSG:3857"'), "site.crs: The CRS EPSG:3857"),
        (replaced("crs", '"EPSG:4326"'), "site.crs: The CRS EPSG:4326"),
        (replaced("crs", '"utm"'), "site.crs: The CRS 'utm' is not known"),
        (replaced("rotation_deg", "inf"), "site.rotation_deg = [inf]"),
        (replaced("reached_tolerance_m", "0"), "site.reached_tolerance_m = 0.0 is not above 0"),
        (replaced("stale_after_s", "9.0"), "liveness.stale_after_s = 9.0 and lost_after_s = 8.0"),
        (replaced("lost_after_s", '"8"'), "liveness.lost_after_s = '8': Expected `float`, got `str`"),
        (TEXT.replace("version = 3\n", ""), "site: Object missing required field `version`"),
        (TEXT.replace("origin", "orgin"), "site.orgin is not a setting: known are bounds, crs,"),
        (TEXT + "colour = 1\n", "liveness.colour is not a setting"),
        (TEXT + "[map]\n", "map is not a setting: known are liveness, site"),
        ("[liveness]\n", "[site] is missing: write a table [site]"),
        ("site = 3\n", "[site] is 3, not a table"),
        ("[site\n", "is not valid TOML"),
    ],
)
def test_a_wrong_value_is_named_with_file_key_value_and_what_is_right(read, tmp_path, text, says):
    with pytest.raises(SettingsError) as caught:
        read(text)
    assert str(caught.value).startswith(str(tmp_path / "site.toml"))
    assert says in str(caught.value)


def test_a_missing_file_says_what_a_site_is(tmp_path):
    with pytest.raises(SettingsError, match=r"site\.toml is missing: a published site is a folder with"):
        read_settings(tmp_path / "site.toml")
