"""The recipes that ship with Raceway, one YAML file per corpus."""
