"""The targets qgc-plan and wpl: missions for ground stations, without a program that runs beside them."""
