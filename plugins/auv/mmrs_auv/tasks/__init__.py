"""Rules for what underwater vehicles do: surveys, profiles, objects, pipelines, fixes at the surface."""
