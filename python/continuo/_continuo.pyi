"""What the package calls in C++."""

__version__: str

class Native:
    """A compiled right-hand side, which a run calls without the interpreter."""

    def __init__(
        self, address: int, jacobian: int = 0, user: int = 0, size: int | None = None, owner: object = None
    ) -> None: ...
    @property
    def address(self) -> int: ...
    @property
    def jacobian(self) -> int: ...
    @property
    def user(self) -> int: ...
    @property
    def size(self) -> int | None: ...
    @property
    def owner(self) -> object: ...
