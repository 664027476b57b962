"""Projects made of drawings: what each feature becomes, and the files that hold it."""
