"""How much each effect changes the contact law, and the number that says when."""
