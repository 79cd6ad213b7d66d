// E1xx: the text cannot be read.
#include <array>

#include <continuo/language/text/codes.hpp>

namespace continuo::model {

namespace {

constexpr std::array syntax_entries = {
    Code{"E101", "this file is not UTF-8 text",
         R"(A model is a text in UTF-8. This file contains a byte that UTF-8 does not allow; the message gives its
offset from the start of the file, counted from 0. Often the file was saved in an older encoding (Latin-1,
Windows-1252), where a letter such as é is one byte, or in UTF-16; or it is no text at all.

Fix: save the file as UTF-8 in the editor, or convert it:  iconv -f latin1 -t utf-8 old.sim > new.sim)"},
    Code{"E102", "a character has no meaning here",
         R"(The language uses letters, digits, and the signs + - * / ^ ( ) [ ] { } , ; : = < > ' " . and #.
Names may contain letters of other alphabets (ω, φ₀); comments and texts may contain any character.

Fix: remove the character, or put it into a comment (# ...) or a text ("...").)"},
    Code{"E103", "a text has no end",
         R"(A text begins and ends with a double quote on the same line:

  mark "apex"
  table drag from "drag.csv"

Inside a text write \" for a quote and \\ for a backslash.)"},
    Code{"E104", "a unit bracket has no end",
         R"(A unit stands in square brackets after its number, on the same line:

  param g = 9.8 [m/s^2]

A square bracket directly after a name, without a space, is an index instead: u[i].)"},
    Code{"E105", "a number does not fit",
         R"(Numbers are stored in double precision, from about 1e-308 to 1e308, with 16 digits.

Fix: choose units in which your numbers are nearer to 1; this also improves the accuracy of the solution.)"},
    Code{"E106", "there is no model in the file",
         R"(The file is empty or holds only comments. The smallest model is

  x' = -x
  x(0) = 1
  run 0..5

`continuo new NAME` writes a model to start from.)"},
    Code{"E107", "an expression or block is nested too deeply",
         R"(Brackets and blocks may be nested 200 deep (an operator before a bracket counts as one more), and an
expression may be 500 operations tall; a sum of 500 terms is that tall, since a + b + c is (a + b) + c.

Fix: give parts a name with `let`, or write a sum of alike terms as

  sum(i in 1..N: k[i]*x[i]))"},
    Code{"E108", "the model is too long",
         R"(A model holds at most a million words and signs. Data belong into a table,

  table load from "load.csv"        then  interp(load, t)

and repeated equations into a family,

  for i in 1..1000 { u[i]' = D*(u[i-1] - 2*u[i] + u[i+1])/dx^2 })"},
    Code{"E110", "something else was expected",
         R"(The statement begins correctly, but then something is missing or in the wrong place. The message shows
what was expected there and what was found.

A statement ends at the end of its line or at `;`. It continues on the next line after an operator, a comma or an open
bracket:

  x'' = -k/m*x -
        c/m*x')"},
    Code{"E111", "no statement begins like this",
         R"(A statement begins with one of these words, or is an equation or an initial value:

  model param let output energy input table unknown guess mode start
  when at every initially for run plot draw check
  world { ... }   force on BODY = (..., ...)   torque on BODY = ...

States need no declaration: x'' = -k*x introduces x. An event contains actions: x := value, if, go, mark, stop, for.)"},
    Code{"E112", "a word of the language cannot be a name",
         R"(Words that begin statements (param, run, when, at, check, ...), the words of actions (go, mark, stop) and
if then else and or not in from for sum cannot name a state, a parameter or a mode.

Fix: choose another name: `run_`, `runs`, `t_run`.)"},
    Code{"E113", "a bracket is not closed, or closes nothing",
         R"(Every ( needs its ) and every index bracket its ]. Inside round brackets a line may end after an operator, a
comma or the open bracket, and before an operator or the closing bracket.)"},
    Code{"E114", "a block has no end",
         R"(A block opened with { was not closed before the end of the file, or before a line that begins in its first
column with a statement that is not allowed in a block (run, when, mode, ...).

Fix: write the missing }; a } may stand on the line of the last statement.)"},
    Code{"E115", "a brace closes nothing",
         R"(There is a } without a { before it. Either it is one too many, or the { was forgotten further up:

  when h falls through 0 { h' := -e*h' })"},
    Code{"E116", "an operator is missing",
         R"(A product needs its sign: 2*x, not 2x or 2 x, and k*(x - l), not k(x - l), which is a call of the
function k. A unit stands in brackets: 3 [m], not 3 m.)"},
    Code{"E117", "comparisons cannot be chained",
         R"(a < b < c means nothing here. Write

  a < b and b < c)"},
    Code{"E118", "`=`, `:=` and `==` are mixed up",
         R"(=   states an equation, a definition or an initial value: it always holds
:=  assigns, at the moment of an event: h' := -e*h'
==  compares, in conditions: if n == 3 then 1 else 0)"},
    Code{"E119", "an action assigns with `:=` to a name",
         R"(An event contains actions, and an assignment is written

  h' := -e*h'

with a state alone on the left side. All right sides are evaluated with the state before the event.)"},
    Code{"E120", "`=` cannot compare",
         R"(Equality in a condition is written ==. But a quantity that changes with time equals a value only for an
instant, so an event is written as a crossing:

  when h falls through 0 { ... }
  at 3 { ... }                     # a time)"},
    Code{"E121", "a list cannot be calculated with",
         R"(Values separated by commas in brackets form a list. A list gives the values of an indexed parameter, the
tolerances of several states, or a point of a drawing:

  param m[1..3] = (1, 2, 3)
  run 0..1 tol 1e-9, abs (1e-9, 1e-6)
  draw { ball (0, h) radius 0.1 }

If a decimal number was meant: its sign is a point, 9.8.)"},
    Code{"E122", "a text cannot be calculated with",
         R"(Texts in quotes are names of files, keys, marks, colours and labels. A state or a parameter is written
without quotes.)"},
    Code{"E123", "this is not allowed here",
         R"(Some statements are allowed only outside of braces (model, run, plot, draw, check, mode, ...), some words
only inside:

  mode flight { equations, let, for }
  for i in 1..N { param, let, output, energy, unknown, guess, for, when, at, equations, initial values }
  when ... { actions: x := value, if, go, mark, stop, for })"},
    Code{
        "E124", "something is given twice",
        R"(A file holds one model with one name, a run one method, one step, one output; a shape one radius. Keep one.)"},
    Code{"E125", "a word is not known here",
         R"(Only certain words are allowed here; the message suggests the most similar one.

  when EXPR falls|rises|crosses [through] VALUE [in MODE] { actions }
  when CONDITION [in MODE] { actions }
  run A..B [unit] output DT | steps | log N per decade from T, method NAME, step H, tol R, abs A, realtime
  draw { floor, ball, spring, rod, rope, arrow, trail, box, text }
  check EXPR [at TIME | at end | before event N | after event N [of "name"]] = VALUE within TOLERANCE)"},
    Code{"E126", "a check and its tolerance do not fit",
         R"(Computed numbers are equal only within a tolerance, so a check with = must state one; a check with < needs
none, and a count is exact:

  check h(1) = 5.1 [m] within 1e-9
  check energy drift < 1e-8
  check always h >= -1e-12
  check time of event 3 = 1.526149906532 within 1e-12
  check count of "h falls" = 30)"},
    Code{"E127", "a sign of another language",
         R"(Powers are written x^2, conditions with and, or, not and !=, comments begin with #, a prime is the straight
single quote ', and an assignment of an event is x := x + 1.)"},
    Code{"E128", "a unit or an index in a wrong place",
         R"(A unit follows a number, a name or a bracket, after a space:  3 [m],  sqrt(2) [m].
An index follows its name without a space:  u[i],  u[i-1]'.

In an expression of numbers only, a unit at the end belongs to the whole expression: 1/2 [m] is half a metre, and
2*pi^2 [m] is 2*pi^2 metres. In an expression with names it belongs to the item before it: v*2 [s] is v*(2 [s]).)"},
    Code{"E129", "a prime in the wrong place",
         R"(Each ' directly after a name is one derivative with respect to time: x' and x''. The index comes before the
primes: u[i]'. Two primes are two single quotes, not a double quote. A derivative is not declared; its equation
has no keyword:

  x'' = -k/m*x)"},
    Code{"E131", "an expression alone is not a statement",
         R"(A statement is an equation (x' = ...), an initial value (x(0) = 1), a definition (let y = ...), or in
an event an assignment (x := ...).)"},
    Code{"E132", "a wrong number of values in brackets",
         R"(An initial value has one time: x(0) = 1; its derivative's is x'(0) = 0, and for an indexed state
u[i](0) = 0. A point of a drawing has two or three coordinates: (0, h).)"},
    Code{
        "E133", "an unknown backslash in a text",
        R"(In a text a backslash goes with one of " \ n t. In names of files write / between folders, on every system.)"},
    Code{"E134", "a derivative is written with a prime",
         R"(dx/dt, der(x) and diff(x, t) are written x', the second derivative x'':

  x'' = -k/m*x)"},
    Code{"E136", "a name is too long", R"(Names have at most 200 bytes, because they are column names of the result.)"},
};

}  // namespace

std::span<const Code> syntax_codes() {
  return syntax_entries;
}

}  // namespace continuo::model
