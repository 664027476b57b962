"""From scenes and plans to behaviours."""
