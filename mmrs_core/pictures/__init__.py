"""Pictures and pages of missions and flights for operators: HTML, SVG and Markdown."""
