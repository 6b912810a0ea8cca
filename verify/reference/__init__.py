"""Reference data: its generator, comparer and schema will live here; `verify` never imports it."""
