"""Works QGIS Desktop by mouse and keyboard, and takes the pictures of the operator's guide."""
