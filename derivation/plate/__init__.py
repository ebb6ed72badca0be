"""The chain from the equilibrium equations to the contact law; `chain.derive` walks it."""
