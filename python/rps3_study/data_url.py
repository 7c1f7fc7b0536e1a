"""Text in the place of an address, for pages that consist of one file."""

import base64


def data_url(kind: str, text: str) -> str:
    """`text` of a media type, e.g. image/svg+xml, as a URL."""
    return f"data:{kind};base64,{base64.b64encode(text.encode()).decode('ascii')}"
