// continuo methods: what can integrate, with order, kind and source.
#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <apps/continuo/options/command_line.hpp>
#include <apps/continuo/options/experiment_options.hpp>
#include <apps/continuo/options/models.hpp>
#include <apps/continuo/options/verb_list.hpp>
#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <apps/continuo/verbs.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <continuo/runs/run.hpp>
#include <continuo/simulation/experiment.hpp>
#include <continuo/solve/catalogue.hpp>

namespace continuo::app {
namespace {

struct MethodsRequest {
  std::string file;
  bool json = false;
};

struct Citation {
  std::string_view method, source;
};
constexpr std::array citations{
    Citation{"explicit_euler", "Euler, Institutiones calculi integralis I (1768); also `euler`"},
    Citation{"semi_implicit_euler", "Hairer, Lubich, Wanner, Geometric Numerical Integration, I.1.2"},
    Citation{"symplectic_euler_position_first",
             "Hairer, Lubich, Wanner, Geometric Numerical Integration, VI.3; x first, then v with a(x)"},
    Citation{"central_difference", "Hairer, Lubich, Wanner, Acta Numerica 12 (2003), leapfrog"},
    Citation{"velocity_verlet", "Swope, Andersen, Berens, Wilson, J. Chem. Phys. 76 (1982)"},
    Citation{"midpoint", "Runge, Math. Ann. 46 (1895)"},
    Citation{"heun", "Heun, Z. Math. Phys. 45 (1900)"},
    Citation{"rk4", "Kutta, Z. Math. Phys. 46 (1901)"},
    Citation{"rk38", "Kutta, Z. Math. Phys. 46 (1901), the 3/8 rule"},
    Citation{"bogacki_shampine3", "Bogacki, Shampine, Appl. Math. Lett. 2 (1989)"},
    Citation{"dormand_prince5", "Dormand, Prince, J. Comp. Appl. Math. 6 (1980)"},
    Citation{"tsitouras5", "Tsitouras, Comput. Math. Appl. 62 (2011)"},
    Citation{"dop853", "Hairer, Norsett, Wanner, Solving ODEs I, II.5 and II.10"},
    Citation{"verner7", "Verner, Numer. Algorithms 53 (2010), most efficient 7(6), https://www.sfu.ca/~jverner/"},
    Citation{"mclachlan_atela4", "McLachlan, Atela, Nonlinearity 5 (1992); symplectic"},
    Citation{"yoshida6", "Yoshida, Phys. Lett. A 150 (1990); symplectic"},
    Citation{"kahan_li8", "Kahan, Li, Math. Comp. 66 (1997); symplectic"},
    Citation{"dprkn6", "Dormand, Prince, Comput. Math. Appl. 13 (1987), Nystrom 6(4)"},
    Citation{"dprkn8", "Dormand, El-Mikkawy, Prince, IMA J. Numer. Anal. 7 (1987), Nystrom 8(6)"},
    Citation{"dprkn12", "Dormand, El-Mikkawy, Prince, IMA J. Numer. Anal. 7 (1987), Nystrom 12(10)"},
    Citation{"newmark", "Newmark, J. Eng. Mech. Div. ASCE 85 (1959), average acceleration"},
    Citation{"generalized_alpha", "Chung, Hulbert, J. Appl. Mech. 60 (1993), spectral radius 0.8"},
    Citation{"adams", "Shampine, Gordon, Computer Solution of ODEs (1975), orders 1 to 12; for costly equations"},
    Citation{"odex",
             "Bulirsch, Stoer, Numer. Math. 8 (1966); Hairer, Norsett, Wanner, Solving ODEs I, II.9, orders 4 to 18"},
    Citation{"taylor", "Jorba, Zou, Exp. Math. 14 (2005), Taylor series of orders 4 to 20; smooth and strict"},
    Citation{"gauss4", "Hairer, Wanner, Solving ODEs II, IV.5; symplectic"},
    Citation{"radau5", "Hairer, Wanner, Solving ODEs II, IV.8"},
    Citation{"radau", "Hairer, Wanner, J. Comput. Appl. Math. 111 (1999), orders 5, 9, 13; stiff and strict"},
    Citation{"tsitouras5_rodas5p", "both, handing over where stiffness begins and ends; the default"},
    Citation{"dop853_radau", "the default for tolerances below 1e-6"},
    Citation{"tsitouras5_bdf", "the default for more than 100 states"},
    Citation{"dprkn8_radau", "the default for x'' = a(t, x)"},
    Citation{"dprkn12_radau", "the default for x'' = a(t, x) and tolerances below 1e-6"},
    Citation{"implicit_euler", "Hairer, Wanner, Solving ODEs II, IV.3"},
    Citation{"trapezoidal", "Crank, Nicolson, Proc. Camb. Phil. Soc. 43 (1947); also `crank_nicolson`"},
    Citation{"implicit_midpoint", "Hairer, Lubich, Wanner, Geometric Numerical Integration, II.1; symplectic"},
    Citation{"bdf2", "Hairer, Norsett, Wanner, Solving ODEs I, III.1"},
    Citation{"trbdf2",
             "Bank et al., IEEE Trans. Electron Devices 32 (1985); Hosea, Shampine, Appl. Num. Math. 20 (1996)"},
    Citation{"kencarp4", "Kennedy, Carpenter, Appl. Numer. Math. 44 (2003), ARK4(3)6L[2]SA"},
    Citation{"kvaerno5", "Kvaerno, BIT 44 (2004)"},
    Citation{"rkc2", "Sommeijer, Shampine, Verwer, J. Comput. Appl. Math. 88 (1998); for diffusion"},
    Citation{"rosenbrock23", "Shampine, Reichelt, SIAM J. Sci. Comput. 18 (1997)"},
    Citation{"rodas4", "Hairer, Wanner, Solving ODEs II, IV.7"},
    Citation{"rodas5p", "Steinebach, BIT 63 (2023); the first choice for stiff systems"},
    Citation{"bdf", "Shampine, Reichelt, SIAM J. Sci. Comput. 18 (1997), NDF of orders 1 to 5"},
    Citation{"seulex", "Deuflhard, SIAM Review 27 (1985); Hairer, Wanner, Solving ODEs II, IV.9, orders 2 to 10"},
    Citation{"verner9", "Verner, Numer. Algorithms 53 (2010), most efficient 9(8), https://www.sfu.ca/~jverner/"},
};

std::string_view source_of(std::string_view method) {
  const auto found = std::ranges::find(citations, method, &Citation::method);
  return found == citations.end() ? "" : found->source;
}

std::string_view kind_of(const MethodInfo& method) {
  if (method.automatic) return method.second_order ? "automatic, x'' = a(t, x)" : "automatic, any system";
  if (method.second_order && method.implicit) return "structures, x'' = a(t, x, x')";
  if (method.second_order) return method.error_order > 0 ? "adaptive, x'' = a(t, x)" : "fixed step, x'' = a(t, x)";
  if (method.implicit) return method.error_order > 0 ? "adaptive, stiff, algebraic" : "fixed step, stiff, algebraic";
  return method.error_order > 0 ? "adaptive" : "fixed step";
}

ExitCode methods(bool json) {
  if (json) {
    auto list = nlohmann::ordered_json::array();
    for (const MethodInfo& method : method_catalogue())
      list.push_back({{"name", method.name},
                      {"order", method.order},
                      {"error_order", method.error_order},
                      {"adaptive", method.error_order > 0},
                      {"implicit", method.implicit},
                      {"second_order", method.second_order},
                      {"automatic", method.automatic},
                      {"kind", kind_of(method)},
                      {"source", source_of(method.name)}});
    answer("continuo.methods/1", {{"methods", list}});
    return done;
  }
  std::string text = fmt::format("{:<31} {:>5}  {:<26} {}\n", "method", "order", "kind", "source");
  for (const MethodInfo& method : method_catalogue()) {
    text +=
        fmt::format("{:<31} {:>5}  {:<26} {}\n", method.name, method.order, kind_of(method), source_of(method.name));
  }
  print(text);
  return done;
}

/// The method that a run of the model would take, and the reason.
ExitCode why(const std::string& file, bool json) {
  if (!readable(file)) return usage;
  const model::Loaded loaded = load_model(file);
  if (!loaded) return wrong_model;
  const model::Model& model = *loaded.model;
  std::vector<model::Diagnostic> problems;
  const auto plan = runs::plan(model, {}, problems);
  show(problems, loaded.source);
  if (!plan) return usage;
  if (json) {
    answer("continuo.method_choice/1", {{"model", model.name}, {"method", plan->method}, {"reason", plan->reason}});
  } else {
    print(fmt::format("{}: {}; {}\n", model.name, plan->method, plan->reason));
  }
  return done;
}

}  // namespace

void add_methods(CLI::App& app, ExitCode& exit) {
  static constexpr std::string_view examples =
      "  continuo methods\n  continuo methods --why models/lorenz.sim\n  continuo run models/kepler.sim --method "
      "dop853\n";
  Verb* verb = add_verb(app, listed("methods"), examples, {wrong_model});
  verb->json_examples = {"continuo methods --json", "continuo methods --why models/lorenz.sim --json"};
  auto request = std::make_shared<MethodsRequest>();
  reads_file(*verb, verb->add_option("--why", request->file, "Shows the method chosen for this model, and the reason"),
             files_of_model);
  verb->add_flag("--json", request->json, "The methods, or the choice, as one JSON object");
  verb->callback(
      [&exit, request] { exit = request->file.empty() ? methods(request->json) : why(request->file, request->json); });
}

}  // namespace continuo::app
