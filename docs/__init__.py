"""The site: pages in Markdown, figures from scripts, reference from docstrings."""
