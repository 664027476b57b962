"""Solar parks for MMRS: panel groups, thermal images along their rows, closer looks at suspected panels."""
