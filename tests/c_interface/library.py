"""The library of continuo.h by ctypes, for the tests."""

import ctypes
import os
from ctypes import POINTER, c_char_p, c_double, c_int, c_size_t, c_void_p

OK, ENDED, ERROR, FAILED, MISUSE = range(5)
STATES, PARAMETERS, COLUMNS, ROWS, EVENTS = range(5)
DEFAULT = -1.7976931348623157e308

FUNCTION = ctypes.CFUNCTYPE(c_int, c_double, POINTER(c_double), POINTER(c_double), c_void_p)

library = ctypes.CDLL(os.environ["CONTINUO_LIBRARY"])
for name, result, arguments in [
    ("version", c_char_p, []),
    ("load", c_int, [c_char_p, POINTER(c_void_p)]),
    ("load_text", c_int, [c_char_p, c_char_p, POINTER(c_void_p)]),
    ("free", None, [c_void_p]),
    ("error_message", c_char_p, [c_void_p]),
    ("error_code", c_char_p, [c_void_p]),
    ("error_hint", c_char_p, [c_void_p]),
    ("error_line", c_int, [c_void_p]),
    ("error_column", c_int, [c_void_p]),
    ("count", c_size_t, [c_void_p, c_int]),
    ("name", c_char_p, [c_void_p, c_int, c_size_t]),
    ("unit", c_char_p, [c_void_p, c_int, c_size_t]),
    ("set_parameter", c_int, [c_void_p, c_char_p, c_double]),
    ("get_parameter", c_int, [c_void_p, c_char_p, POINTER(c_double)]),
    ("set_initial", c_int, [c_void_p, c_char_p, c_double]),
    ("set_method", c_int, [c_void_p, c_char_p]),
    ("set_option", c_int, [c_void_p, c_char_p, c_double]),
    ("run", c_int, [c_void_p, c_double]),
    ("read_column", c_int, [c_void_p, c_char_p, POINTER(c_double), c_size_t]),
    ("read_rows", c_int, [c_void_p, POINTER(c_double), c_size_t]),
    ("outcome", c_char_p, [c_void_p]),
    ("interrupt", None, [c_void_p]),
    ("start", c_int, [c_void_p]),
    ("advance", c_int, [c_void_p, c_double]),
    ("time", c_double, [c_void_p]),
    ("get_state", c_int, [c_void_p, POINTER(c_double), c_size_t]),
    ("set_state", c_int, [c_void_p, POINTER(c_double), c_size_t]),
    ("event", c_int, [c_void_p, c_size_t, POINTER(c_double), POINTER(c_char_p)]),
    ("integrate", c_int, [FUNCTION, c_void_p, c_size_t, POINTER(c_double), POINTER(c_double), c_size_t,
                          c_char_p, c_double, c_double, POINTER(c_double), c_char_p, c_size_t]),
]:  # fmt: skip
    function = getattr(library, "continuo_" + name)
    function.restype, function.argtypes = result, arguments


class Model:
    """A handle with the functions of continuo.h as methods; texts are str."""

    def __init__(self, text=None, path=None):
        self.handle = c_void_p()
        if path is not None:
            self.loaded = library.continuo_load(path.encode(), ctypes.byref(self.handle))
        else:
            self.loaded = library.continuo_load_text(text.encode(), b"test", ctypes.byref(self.handle))

    def __del__(self):
        library.continuo_free(self.handle)

    def __getattr__(self, name):
        function = getattr(library, "continuo_" + name)

        def call(*arguments):
            encoded = [a.encode() if isinstance(a, str) else a for a in arguments]
            result = function(self.handle, *encoded)
            return result.decode() if isinstance(result, bytes) else result

        return call

    def column(self, name):
        rows = self.count(ROWS)
        buffer = (c_double * rows)()
        assert self.read_column(name, buffer, rows) == OK, self.error_message()
        return list(buffer)

    def state(self):
        n = self.count(STATES)
        buffer = (c_double * n)()
        assert self.get_state(buffer, n) == OK, self.error_message()
        return list(buffer)

    def put(self, *values):
        return self.set_state((c_double * len(values))(*values), len(values))

    def events(self):
        found = []
        for i in range(self.count(EVENTS)):
            t, name = c_double(), c_char_p()
            assert self.event(i, ctypes.byref(t), ctypes.byref(name)) == OK
            found.append((t.value, name.value.decode()))
        return found


def integrate(f, y0, times, method=None, rtol=DEFAULT, atol=DEFAULT):
    """The code, the rows and the message of continuo_integrate; f takes and gives lists."""
    n = len(y0)

    def call(t, y, dydt, _):
        result = f(t, y[:n])
        if result is None:
            return 1
        for i in range(n):
            dydt[i] = result[i]
        return 0

    rows = (c_double * (n * len(times)))()
    message = ctypes.create_string_buffer(200)
    code = library.continuo_integrate(
        FUNCTION(call), None, n, (c_double * n)(*y0), (c_double * len(times))(*times), len(times),
        method.encode() if method else None, rtol, atol, rows, message, len(message),
    )  # fmt: skip
    return code, [rows[i * n : (i + 1) * n] for i in range(len(times))], message.value.decode()
