"""What is wrong and matters, told so that it can be sent to those who can mend it."""
