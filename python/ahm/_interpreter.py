"""Raises ImportError in a subinterpreter, before any extension module is loaded."""

try:
    import _interpreters
except ImportError:  # before Python 3.13
    try:
        import _xxsubinterpreters as _interpreters
    except ImportError:  # this Python has no subinterpreters
        _interpreters = None

if _interpreters is not None and _interpreters.get_current() != _interpreters.get_main():
    raise ImportError("ahm works in the main interpreter only; use threads or processes instead of subinterpreters")
