"""What is known about foreign forces before they are believed: sign, balance, frames, completeness."""
