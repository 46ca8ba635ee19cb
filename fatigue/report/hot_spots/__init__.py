"""Hot spots: weld by face by stretch. ``stretches`` finds them on lines, ``of_result`` makes a table of them."""
