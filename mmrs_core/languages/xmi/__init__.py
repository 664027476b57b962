"""Models as XML: XMI as Eclipse writes it, read and written."""
