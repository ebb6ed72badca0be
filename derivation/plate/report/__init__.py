"""What only this paper's report has: sections, tables and figures."""
