// continuo/language/check/names/elsewhere.cpp
// Functions and names that people bring along from other languages, and what is written here instead.
#include <algorithm>
#include <span>

#include <continuo/language/check/names/functions.hpp>

namespace continuo::model::detail {

namespace {

struct Elsewhere {
  std::string_view name, here;
};

namespace other_languages {

constexpr std::string_view random =
    "a run is the same each time: read a random course from a file, as in input noise = 0 from \"noise.csv\"";
constexpr std::string_view jump = "write if x < 0 then 0 else 1; what happens at a time is an event: at 3 { ... }";
constexpr std::string_view pulse = "write if t >= 1 and t < 2 then 1 else 0";
constexpr std::string_view derivative =
    "a derivative is written with a prime, x', and only what has an equation has one";
constexpr std::string_view integral = "an integral is a state: I' = f and I(0) = 0";
constexpr std::string_view late = "what was is not kept; a lag is a state of its own: late' = (x - late)/tau";
constexpr std::string_view before = "actions read the state from before the event, without a word: x := -x";
constexpr std::string_view between = "write min(max(x, low), high)";
constexpr std::string_view special =
    "tabulate it: table values from \"values.csv\", a file with x and the function, and interp(values, x)";
constexpr std::string_view table = "declare table NAME from \"file.csv\" and write interp(NAME, x)";
constexpr std::string_view choice = "write if c then a else b";

constexpr Elsewhere functions[] = {
    {"arccos", "write acos(x)"},
    {"arcsin", "write asin(x)"},
    {"arctan", "write atan(x)"},
    {"arctan2", "write atan2(y, x)"},
    {"besselj", special},
    {"beta", special},
    {"clamp", between},
    {"clip", between},
    {"cot", "write 1/tan(x)"},
    {"csc", "write 1/sin(x)"},
    {"ddt", derivative},
    {"deg2rad", "write x*pi/180"},
    {"delay", late},
    {"der", derivative},
    {"deriv", derivative},
    {"diff", derivative},
    {"dirac", "a blow is an event: at 3 { v := v + 1 }"},
    {"edge", "an event is an edge: when x > 0 { ... }"},
    {"erf", "as a state E' = 2/sqrt(pi)*exp(-x^2)*x' with E(0) = 0 where x is 0, or tabulated: interp(TABLE, x)"},
    {"erfc", "as a state E' = -2/sqrt(pi)*exp(-x^2)*x' with E(0) = 1 where x is 0, or tabulated: interp(TABLE, x)"},
    {"exp2", "write 2^x"},
    {"expm1", "write exp(x) - 1, or 2*exp(x/2)*sinh(x/2), which keeps its digits near 0"},
    {"fabs", "write abs(x)"},
    {"factorial", special},
    {"fix", "write sign(x)*floor(abs(x))"},
    {"fmod", "write mod(x, y), which has the sign of y"},
    {"gamma", special},
    {"gaussian", random},
    {"heaviside", jump},
    {"Heaviside", jump},
    {"ifelse", choice},
    {"iif", choice},
    {"int", integral},
    {"integral", integral},
    {"integrate", integral},
    {"interp1", table},
    {"interpolate", table},
    {"lgamma", special},
    {"limit", between},
    {"log1p", "write log(1 + x)"},
    {"lookup", table},
    {"noEvent", "write smooth(x)"},
    {"noise", random},
    {"normal", random},
    {"piecewise", choice},
    {"power", "write x^y"},
    {"pre", before},
    {"previous", before},
    {"pulse", pulse},
    {"rad2deg", "write x*180/pi"},
    {"ramp", "write max(0, t - 1)"},
    {"rand", random},
    {"randn", random},
    {"random", random},
    {"rect", pulse},
    {"reinit", "in an event write x := value"},
    {"rem", "write mod(x, y), which has the sign of y"},
    {"sat", between},
    {"saturate", between},
    {"sawtooth", "write mod(t, 1)"},
    {"sec", "write 1/cos(x)"},
    {"sgn", "write sign(x)"},
    {"signum", "write sign(x)"},
    {"sinc", "write if x == 0 then 1 else sin(x)/x"},
    {"square", "x^2, or for a square wave if mod(t, 2) < 1 then 1 else -1"},
    {"step", jump},
    {"trunc", "write sign(x)*floor(abs(x))"},
    {"uniform", random},
    {"where", choice},
};

constexpr std::string_view no_infinity = "there is no infinite number; write a large one, such as 1e300";

constexpr Elsewhere names[] = {
    {"Infinity", no_infinity},
    {"Inf", no_infinity},
    {"NaN", "leave the value out, or write a number"},
    {"PI", "write pi"},
    {"Pi", "write pi"},
    {"Time", "time is `t`"},
    {"e", "Euler's number is exp(1), its power e^x is written exp(x)"},
    {"inf", no_infinity},
    {"infinity", no_infinity},
    {"rand", random},
    {"random", random},
    {"time", "time is `t`"},
    {"\xCF\x80", "write pi"},
};

}  // namespace other_languages

std::string_view find_in(std::span<const Elsewhere> list, std::string_view name) {
  const auto found = std::ranges::find(list, name, &Elsewhere::name);
  return found == list.end() ? std::string_view() : found->here;
}

}  // namespace

std::string_view function_from_elsewhere(std::string_view name) {
  return find_in(other_languages::functions, name);
}
std::string_view name_from_elsewhere(std::string_view name) {
  return find_in(other_languages::names, name);
}

}  // namespace continuo::model::detail
