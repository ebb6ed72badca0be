"""What papers share and no paper owns."""
