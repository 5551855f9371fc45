"""The paper's own sample, and small outlines to build maps from."""

from __future__ import annotations

import pytest

FIG_2 = """\
border;
-4;100;
100;-4;
#
obstacle;
1;1;4;column,A5;
#
4.53;12.10;
7.29;12.10;
5;1;wall,orange,brick;%11
#
obstacle;
110;2;1;wall,A4;
#
-3;0;
-4;0;
1.2;1;wall,greycement;
#
"""


@pytest.fixture
def fig_2() -> str:
    """The paper's Fig. 2, verbatim."""
    return FIG_2
