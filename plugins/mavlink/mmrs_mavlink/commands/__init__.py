"""Commands of the command line of MMRS that this plug-in adds."""
