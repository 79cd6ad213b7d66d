// What every recording of a run contains, of equations and of worlds: its head and its end.
#pragma once
#include <cstdint>
#include <string>

#include <continuo/simulation/experiment.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/simulation/run.hpp>
#include <continuo/solve/outcome.hpp>

namespace continuo::model {

/// The head of a recording: the text of the model, and the experiment.
struct RunHead {
  std::string version{};       // of the program
  std::string file{}, text{};  // the folder of the file is where tables are
  std::uint64_t data = 0;      // the checksum of the tables that the model reads
  bool decides_size = false;   // the parameters are needed when the text is read
  bool as_written = true;      // the checks of the model apply to this run
  Experiment experiment{};
};

/// How a recorded run ended.
struct RunEnd {
  Outcome<double> outcome{};  //
  std::string stop_text{};    // of the `stop` that ended it
  std::string error{};        // why bodies could not be moved on
  Statistics statistics{};    // what it cost, with what came before a break
};

/// Who gets the rows of a replayed or resumed run, from its beginning.
struct RowsOfRecording {
  OnRow on_row{};
  bool keep_rows = true;  // as in Experiment; that of the recorded one does not matter
};

/// A checksum of all tables, meshes and chains that the model reads from files.
[[nodiscard]] std::uint64_t checksum_of_tables(const ModelProgram& program);

}  // namespace continuo::model
