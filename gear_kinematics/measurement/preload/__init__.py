"""Recordings at several settings of the preload, and the setting that they advise."""
