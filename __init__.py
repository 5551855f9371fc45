"""Fleet Supervisor, a QGIS plugin. QGIS loads this folder as the package ``fleet_supervisor``."""


def classFactory(iface):  # noqa: ANN001, N802 - the name that QGIS calls; Language comes before all imports
    """Return the plugin; ``iface`` is QGIS's QgisInterface, or None under qgis_process."""
    from .plugin.ui.language import Language

    # Before the rest of the plugin is imported: its modules hold texts.
    language = Language()
    from .plugin.plugin import FleetPlugin

    return FleetPlugin(iface, language)
