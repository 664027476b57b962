"""The bus for programs that have no Zenoh."""
