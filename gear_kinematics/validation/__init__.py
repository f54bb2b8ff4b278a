"""What a node published, against what it should have published."""
