"""The target imc: plans for the vehicles of LSTS, in the messages of their IMC protocol (5.4)."""
