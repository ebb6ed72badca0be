"""Parts of the report that only this paper has: sections, tables and figures."""
