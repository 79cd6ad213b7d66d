#!/bin/sh
# refusals.sh SOURCE COMPILER FLAG...
# Compiles a source that must be refused. Every comment `// refused: SENTENCE` must be one error of the compiler, and it
# must find no other error. One call of the compiler finds all mistakes of a source.
source=$1
shift
output=$(LC_ALL=C "$@" -fsyntax-only "$source" 2>&1)
errors=$(printf '%s\n' "$output" | grep 'error:')
expected=$(sed -n 's,^// refused: ,,p' "$source")
failed=0
printf '%s\n' "$expected" | sort | uniq -c | while read -r count sentence; do
  found=$(printf '%s\n' "$errors" | grep -c -F -- "$sentence")
  [ "$found" -ge "$count" ] || echo "expected $count times, found $found times: $sentence"
done >"${TMPDIR:-/tmp}/refusals.$$"
missing=$(cat "${TMPDIR:-/tmp}/refusals.$$")
rm -f "${TMPDIR:-/tmp}/refusals.$$"
[ -z "$missing" ] || { printf '%s\n' "$missing"; failed=1; }
of_expected=$(printf '%s\n' "$expected" | wc -l)
of_found=$(printf '%s\n' "$errors" | wc -l)
[ "$of_expected" -eq "$of_found" ] || { echo "expected $of_expected errors, found $of_found"; failed=1; }
[ $failed -eq 0 ] || printf '%s\n' "$output"
exit $failed
