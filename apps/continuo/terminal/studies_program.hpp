// The second program of the command, which has the verbs that need the module studies.
#pragma once

namespace continuo::app {

/// Replaces this process by the program continuo-studies with the same words, so that signals, standard input and
/// output and the exit code are its own. Returns only where that fails, after saying why. The variable CONTINUO_STUDIES
/// names another program to start instead: continuo.sh sets it to one that builds continuo-studies first.
void become_studies_program(char** words);

}  // namespace continuo::app
