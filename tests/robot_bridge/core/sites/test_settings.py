"""site.toml: what is written is read back, and each wrong value is named with its place."""

from dataclasses import replace

import pytest

from robot_bridge.core.errors import SettingsError
from robot_bridge.core.sites.frame import SiteBounds
from robot_bridge.core.sites.settings import SiteSettings, read_settings, settings_text
from robot_bridge.core.sites.settings_tables import (
    CommandSettings,
    GatewayOptions,
    LivenessLimits,
    TrajectorySettings,
    value_text,
)

SETTINGS = SiteSettings(
    id="yard-1",
    name='The "north" yard, č. 1',
    version=3,
    crs="EPSG:32633",
    origin=(640420.0, 5193480.5),
    bounds=SiteBounds(-10.0, 0.0, 200.0, 160.0),
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
        (
            TEXT.replace("origin", "orgin"),
            "site.orgin is not a setting: did you mean origin? Known are bounds",
        ),
        (TEXT + "colour = 1\n", "liveness.colour is not a setting"),
        (TEXT + "[chart]\n", "chart is not a setting: known are audit, commands"),
        (TEXT + "[trajectorys]\n", "trajectorys is not a setting: did you mean trajectories?"),
        (
            TEXT + "[trajectories]\nkeep_day = 3\n",
            "trajectories.keep_day is not a setting: did you mean keep_days?",
        ),
        (TEXT + "[trajectories]\nkeep_days = 0\n", "trajectories.keep_days = 0.0 is not above 0."),
        (
            TEXT + "[trajectories]\nkeep_days = '9'\n",
            "trajectories.keep_days = '9': Expected `float`, got `str`",
        ),
        (TEXT + "[trajectories]\nmin_turn_deg = 400\n", "trajectories.min_turn_deg = 400.0 is above 360."),
        (
            TEXT + "[commands]\nexpire_after_s = nan\n",
            "commands.expire_after_s = nan: nan and inf are no numbers",
        ),
        (
            TEXT + "[observations]\nlargest_image_bytes = 3\n",
            "observations.largest_image_bytes = 3 is below 1024.",
        ),
        (
            TEXT + "[observations]\nlargest_image_bytes = 15728640\n",
            "observations.largest_image_bytes = 15728640 is above 8000000.",
        ),
        (TEXT + "[gateway]\nport = 70000\n", "gateway.port = 70000 is above 65535."),
        (TEXT + "[gateway]\nport = true\n", "gateway.port = True: Expected `int | null`, got `bool`"),
        (replaced("stale_after_s", "-1.0"), "liveness.stale_after_s = -1.0 is not above 0."),
        ("gateway = 3\n" + TEXT, "[gateway] is 3, not a table"),
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


EDITED = (
    TEXT.replace("[liveness]", "# ours\n[liveness] # seconds")
    + """
[trajectories]
keep_days = 7 # the works council wants no more
[gateway]
database = "postgresql://fleet@db/fleet"
"""
)


def test_publishing_again_changes_what_was_published_and_leaves_what_the_operator_set(read):
    again = replace(SETTINGS, version=4, name="[new]", liveness=LivenessLimits(2.0, 9.0))
    text = settings_text(again, EDITED)
    settings = read(text)
    assert settings == replace(
        again,
        trajectories=TrajectorySettings(keep_days=7.0),
        gateway=GatewayOptions(database="postgresql://fleet@db/fleet"),
    )
    for kept in ("# ours", "# seconds", "keep_days = 7 # the works council wants no more"):
        assert kept in text
    assert settings_text(again, text) == text


def test_an_array_over_several_lines_is_replaced_whole(read):
    text = TEXT.replace(
        "[640420.0, 5193480.5]", "[ # in metres, [east, north\n    640420.0,\n    5193480.5, # ]\n]"
    )
    assert read(text) == SETTINGS
    moved = replace(SETTINGS, origin=(1.0, 2.0))
    assert read(settings_text(moved, text)) == moved


def test_a_key_that_is_missing_is_added_to_its_table(read):
    text = "\n".join(line for line in EDITED.splitlines() if not line.startswith(("rotation_deg", "lost_")))
    assert read(settings_text(SETTINGS, text)).rotation_deg == 12.5
    assert read(settings_text(SETTINGS, text)).trajectories.keep_days == 7.0


def test_settings_that_are_no_defaults_are_written(read):
    chosen = replace(SETTINGS, trajectories=TrajectorySettings(keep_days=3.5), commands=CommandSettings(60.0))
    assert read(settings_text(chosen)) == chosen


@pytest.mark.parametrize(
    ("table", "key", "found"),
    [
        ("site", "id", '"yard-1"'),
        ("liveness", "stale_after_s", "2.0"),
        ("trajectories", "keep_days", "7"),
        ("gateway", "database", '"postgresql://fleet@db/fleet"'),
        ("site", "keep_days", None),
        ("nowhere", "id", None),
    ],
)
def test_a_value_is_found_by_its_shape_where_no_toml_is_read(table, key, found):
    assert value_text(EDITED, table, key) == found
