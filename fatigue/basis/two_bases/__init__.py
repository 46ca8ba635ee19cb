"""Two bases of one body beside each other, whose interfaces were chosen differently: how far the results move."""
