"""What can be wrong with a site; every message names what, where and what to do."""

from __future__ import annotations


class SiteError(Exception):
    """A site, its settings or its CRS cannot be used."""


class SettingsError(SiteError):
    """``site.toml`` is missing, unreadable or holds a wrong value."""


class LayerError(SiteError):
    """``site.gpkg`` is missing or damaged, or one of its layers is."""


class CrsError(SiteError):
    """A CRS cannot carry a site: unknown, geographic, not in metres, or EPSG:3857."""


class CacheError(SiteError):
    """``site.cache`` is damaged, or belongs to another publication; the site can be read without it."""
