"""The documentation inside the FMUs: `documentation/index.html` and the icon `model.png`."""
