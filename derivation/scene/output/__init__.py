"""Results as text, tables, plots and files."""
