"""What the basis gives to the points where forces enter the body: local flexibility and interface modes."""
