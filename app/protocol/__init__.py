"""Everything that pages and Python say to one another, each message one frozen structure.

The JavaScript side (`static/*/protocol.js`) is written by `python -m app.protocol` from the same
structures: whoever changes one runs that.
"""
