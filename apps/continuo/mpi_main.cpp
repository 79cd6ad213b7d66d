// The program continuo-mpi: sweeps made by all the processes that mpirun starts.
//
//   mpirun -n 64 continuo-mpi sweep spring.sim -o spring.nc
#include <array>
#include <string_view>

#include <apps/continuo/command.hpp>
#include <apps/continuo/mpi_ranks.hpp>
#include <apps/continuo/options/verb_list.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <apps/continuo/verbs.hpp>

namespace {

using namespace continuo::app;

/// Whether the words are for a verb of this program.
bool are_for_sweeps(int argc, char** argv) {
  return argc > 1 && (std::string_view(argv[1]) == "sweep" || std::string_view(argv[1]).starts_with("-"));
}

int run(int argc, char** argv, MpiRanks& ranks) {
  if (!are_for_sweeps(argc, argv)) {
    if (ranks.is_first())
      say("continuo-mpi makes sweeps on many processors: mpirun -n 4 continuo-mpi sweep FILE -o OUT; everything else "
          "is done by continuo");
    return usage;
  }
  const std::array verbs{OwnVerb{"sweep", [&ranks](CLI::App& app, ExitCode& exit) { add_sweep(app, exit, &ranks); }}};
  return run_command(argc, argv, verbs);
}

}  // namespace

int main(int argc, char** argv) {
  MpiRanks ranks(argc, argv);
  return run(argc, argv, ranks);
}
