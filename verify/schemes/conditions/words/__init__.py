"""Words in the letters of a splitting, with their times, and the conditions on a step by them."""
