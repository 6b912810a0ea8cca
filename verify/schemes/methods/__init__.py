"""The schemes, one file each, in folders by family."""
