"""Where a database is: what is refused, with what is right; a password is never shown."""

from __future__ import annotations

import pytest

from robot_bridge.core.errors import StoreError
from robot_bridge.gateway.storage.database import open_engine, read_address, shown

FORMS = "write (it like )?sqlite:////path/fleet.db, postgresql://"


@pytest.mark.parametrize(
    ("url", "text"),
    [
        ("fleet.db", "database URL 'fleet.db' cannot be read; " + FORMS),
        ("", "database URL '' cannot be read; " + FORMS),
        ("mysql://u@h/d", "mysql is not supported; " + FORMS),
        ("postgres://u@h/d", "postgres is not supported; " + FORMS),
        ("postgresql+psycopg2://u@h/d", r"postgresql\+psycopg2 is not supported"),
        ("postgresql://u@h:port/d", "cannot be read; " + FORMS),
        ("sqlite://", "database sqlite://: no file is named; write it like sqlite:////path/fleet.db"),
        ("sqlite://fleet.db", "database sqlite://fleet.db: no file is named"),
        ("sqlite:///:memory:", "no file is named; write it like sqlite:"),
    ],
)
def test_an_address_of_no_known_database_is_refused_with_what_is_right(url, text):
    with pytest.raises(StoreError, match=text):
        read_address(url)


@pytest.mark.parametrize(
    "url",
    [
        "mysql://u:hunter2@h/d",
        "postgresql://u:hunter2@h:port/d",
        "postgresql://u@h/d?password=hunter2",
        "mariadb://u@h/d?passwd=hunter2",
        "u:hunter2@h/d",
    ],
)
def test_a_password_is_not_shown_in_what_is_refused(url):
    with pytest.raises(StoreError) as caught:
        read_address(url)
    assert "hunter2" not in str(caught.value)


@pytest.mark.parametrize("kind", ["postgresql", "mariadb"])
def test_an_address_is_shown_without_its_password_and_options(kind):
    url = read_address(f"{kind}://fleet:hunter2@db.site/fleet?connect_timeout=3")
    assert shown(url) == f"{kind}://fleet:***@db.site/fleet"
    assert "hunter2" not in f"{url} {url!r}"
    engine, _ = open_engine(url)
    assert "hunter2" not in f"{engine!r}"


def test_a_password_comes_from_the_first_line_of_a_file(tmp_path):
    file = tmp_path / "password"
    file.write_text("s3cret @:/ word\nsecond line\n", encoding="utf-8")
    file.chmod(0o600)
    url = read_address("postgresql://fleet@db.site/fleet", file)
    assert url.password == "s3cret @:/ word"
    assert "s3cret" not in shown(url)


@pytest.mark.parametrize(
    ("content", "mode", "text"),
    [
        ("hunter2\n", 0o644, "can be read by every account here; run: chmod 600"),
        ("", 0o600, "is empty; write the password into its first line"),
        (b"\xff\xfe", 0o600, "it is no text"),
        (None, 0o600, "No such file"),
    ],
)
def test_a_password_file_that_cannot_be_used_is_named(tmp_path, content, mode, text):
    file = tmp_path / "password"
    if content is not None:
        file.write_bytes(content if isinstance(content, bytes) else content.encode())
        file.chmod(mode)
    with pytest.raises(StoreError, match=text) as caught:
        read_address("postgresql://fleet@db.site/fleet", file)
    assert str(file) in str(caught.value)
    assert "hunter2" not in str(caught.value)


def test_a_driver_that_is_missing_is_named_with_how_to_install_it(monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "pymysql", None)
    with pytest.raises(StoreError, match=r"its driver is missing .*pip install .*\[mariadb\]"):
        open_engine(read_address("mariadb://u@h/d"))
