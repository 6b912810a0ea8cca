"""What the commands share: options, answers, texts, streams."""
