"""Places at which a user's map is looked at, and the sizes of what moves there."""
