"""The dashboard and the headless evolution behind `geswarm-ui`."""
