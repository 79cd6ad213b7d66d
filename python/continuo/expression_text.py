"""Symbolic numbers written as expressions of the language of models."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .expressions import Expression

__all__ = ["Writer", "text_of"]

# How tightly an operation binds: the larger, the tighter.
_LEVELS = {"if": 0, "or": 1, "and": 2, "not": 3, "<": 4, "<=": 4, ">": 4, ">=": 4, "==": 4, "!=": 4,
           "+": 5, "-": 5, "*": 6, "/": 6, "negate": 7, "^": 8}  # fmt: skip
_ATOM = 9
_DEEPEST = 60  # operations within each other, before a name is given


class Writer:
    """Writes expressions as the language has them; what is used twice, or is deep, gets a name of its own.

    Parameters
    ----------
    results : list of Expression
        What will be written.
    prefix : str
        Of the names that are given.
    """

    def __init__(self, results: list[Expression], prefix: str) -> None:
        self.definitions: list[tuple[str, str]] = []  # name and text, in an order in which they can be read
        self._prefix = prefix
        self._written: dict[int, tuple[str, int, int]] = {}  # by id: text, level, depth
        self._uses: dict[int, int] = {}
        for node in self._in_order(results):
            self._write(node)

    def text(self, expression: Expression) -> str:
        """The text of one of the results."""
        return self._written[id(expression)][0]

    def _in_order(self, results: list[Expression]) -> list[Expression]:
        """Each node once, behind its arguments; counts how often each is read."""
        order: list[Expression] = []
        state: dict[int, bool] = {}
        stack = list(reversed(results))
        for result in results:
            self._uses[id(result)] = self._uses.get(id(result), 0) + 1
        while stack:
            node = stack.pop()
            if id(node) not in state:
                state[id(node)] = False
                stack.append(node)
                for argument in reversed(node.arguments):
                    self._uses[id(argument)] = self._uses.get(id(argument), 0) + 1
                    if id(argument) not in state:
                        stack.append(argument)
            elif not state[id(node)]:
                state[id(node)] = True
                order.append(node)
        return order

    def _write(self, node: Expression) -> None:
        if node.operation == "name":
            written = (str(node.value), _ATOM, 0)
        elif node.operation == "number":
            number = repr(node.value)
            level = _LEVELS["negate"] if number.startswith("-") else _ATOM
            written = (number[:-2] if number.endswith(".0") else number, level, 0)
        else:
            written = self._operation(node)
            if self._uses[id(node)] > 1 or written[2] > _DEEPEST:
                name = f"{self._prefix}{len(self.definitions) + 1}"
                self.definitions.append((name, written[0]))
                written = (name, _ATOM, 0)
        self._written[id(node)] = written

    def _argument(self, node: Expression, level: int) -> str:
        text, its_level, _ = self._written[id(node)]
        return text if its_level >= level else f"({text})"

    def _operation(self, node: Expression) -> tuple[str, int, int]:
        operation, arguments = node.operation, node.arguments
        depth = 1 + max(self._written[id(argument)][2] for argument in arguments)
        level = _LEVELS.get(operation, _ATOM)
        if operation == "if":
            condition, a, b = (self._argument(argument, 1) for argument in arguments)
            return f"if {condition} then {a} else {b}", level, depth
        if operation == "negate":
            return f"-{self._argument(arguments[0], 8)}", level, depth
        if operation == "not":
            return f"not ({self._argument(arguments[0], 0)})", level, depth
        if level == _ATOM:
            return f"{operation}({', '.join(self._argument(a, 0) for a in arguments)})", level, depth
        if operation == "^":
            left, right = (self._argument(argument, _ATOM) for argument in arguments)
            return f"{left}^{right}", level, depth
        # Sums and products read from the left; comparisons and logic stand in brackets.
        is_left_associative = operation in "+-*/"
        left = self._argument(arguments[0], level if is_left_associative else level + 1)
        right = self._argument(arguments[1], level + 1)
        if is_left_associative and right.startswith("-"):
            right = f"({right})"
        blank = "" if level == 6 else " "
        return f"{left}{blank}{operation}{blank}{right}", level, depth


def text_of(expression: Expression) -> str:
    """The expression as the language has it, with all that it is made of."""
    writer = Writer([expression], "#")
    text = writer.text(expression)
    return text if not writer.definitions or not text.startswith("#") else writer.definitions[-1][1]
