"""The paper's scenes and claims, as data; this package's TOML files."""
