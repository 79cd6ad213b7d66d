"""The layout of a JSON value, by an example: names with example values, long arrays cut to their first elements."""
import json


def merged(values):
    """One value with all keys that occur in any of the objects."""
    if all(isinstance(value, dict) for value in values):
        keys = {}
        for value in values:
            for key, inner in value.items():
                keys.setdefault(key, []).append(inner)
        return {key: merged(inner) for key, inner in keys.items()}
    if all(isinstance(value, list) for value in values):
        return max(values, key=len)
    return next((value for value in values if value is not None), None)


def scalar(value):
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, str) and len(value) > 60:
        return json.dumps(value[:57] + "...", ensure_ascii=False)
    return json.dumps(value, ensure_ascii=False)


def layout(value, indent=""):
    deeper = indent + "  "
    if isinstance(value, dict):
        if not value:
            return "{}"
        if len(value) <= 4 and not any(isinstance(inner, (dict, list)) for inner in value.values()):
            return "{" + ", ".join(f"{json.dumps(key)}: {scalar(inner)}" for key, inner in value.items()) + "}"
        inside = (f"{deeper}{json.dumps(key, ensure_ascii=False)}: {layout(inner, deeper)}" for key, inner in value.items())
        return "{\n" + ",\n".join(inside) + f"\n{indent}}}"
    if isinstance(value, list):
        if not value:
            return "[]"
        if all(not isinstance(inner, (dict, list)) for inner in value):
            shown = [scalar(inner) for inner in value[:3]] + (["..."] if len(value) > 3 else [])
            return "[" + ", ".join(shown) + "]"
        more = f",\n{deeper}..." if len(value) > 1 else ""
        return f"[\n{deeper}{layout(merged(value), deeper)}{more}\n{indent}]"
    return scalar(value)


def documents(text):
    """The JSON values of an output, which may contain several."""
    decoder, position, found = json.JSONDecoder(), 0, []
    text = text.strip()
    while position < len(text):
        value, position = decoder.raw_decode(text, position)
        found.append(value)
        while position < len(text) and text[position].isspace():
            position += 1
    return found
