"""Reading and writing: an exporter knows only a Solution."""
