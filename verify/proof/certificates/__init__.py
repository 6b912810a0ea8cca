"""What a proof rests on as JSON, and a checker that shares nothing with the prover."""
