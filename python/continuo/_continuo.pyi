"""What the package calls in C++."""

__version__: str
