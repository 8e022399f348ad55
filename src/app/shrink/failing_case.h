// Which run `kadans shrink` is asked to reduce: a scenario with what the command line sets, or a case of a sweep.
#pragma once

#include "app/commands.h"

namespace kadans {

// The choices of the run: those of the command line, or those of the line that repeats the sweep's case. Throws
// InputError when the file is none, is a record, or is a case that passed.
RunChoices failing_case(const ShrinkOptions& options);

}  // namespace kadans
