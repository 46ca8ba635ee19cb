"""The command for what the channels of a ride say."""
