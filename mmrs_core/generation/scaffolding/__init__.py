"""New plug-ins: everything that makes one, written from templates."""
