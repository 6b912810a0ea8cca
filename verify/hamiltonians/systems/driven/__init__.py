"""Systems whose H depends on time."""
