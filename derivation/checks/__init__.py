"""Random scenes against everything computed: what neither engine nor plate can hold."""
