"""Logos for tests: the smallest pictures of each kind."""

import base64

PNG = base64.b64decode(
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNkYPhfDwAChwGA60e6kgAAAABJRU5ErkJggg=="
)
JPEG = b"\xff\xd8\xff\xe0\x00\x10JFIF\x00" + bytes(40) + b"\xff\xd9"


def svg(inside="", attributes=""):
    """A vector graphic with something in it."""
    head = f'<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" {attributes} '
    return f'{head}viewBox="0 0 60 20"><rect width="60" height="20" fill="#0b5c8a"/>{inside}</svg>'.encode()
