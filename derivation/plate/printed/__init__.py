"""The equations as the paper prints them."""
