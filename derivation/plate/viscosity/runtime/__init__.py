"""The viscoelastic contact, copied into the generated package."""
