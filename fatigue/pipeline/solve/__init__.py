"""From files to what a group of welds is: its body, its forces, and the modal stress of its stations."""
