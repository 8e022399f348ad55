// Which run `kadans shrink` is asked to reduce: a scenario with what the command line sets, or a case of a sweep.
#pragma once

#include "app/commands.h"

namespace kadans {

// `kadans shrink`: the least with which a scenario, or a case of a sweep, still fails in the same way.
struct ShrinkOptions : RunChoices {     // `scenario` may also be the results of a sweep, or one of them
  std::string check;                    // that shall fail; "": the first that does
  std::optional<std::uint32_t> number;  // of the sweep's case
  std::uint32_t runs_max = 2000;
  unsigned jobs = 0;  // 0: one for each core
  std::string out;    // "": NAME_shrunk.json
  bool overwrite = false;
  bool json = false;
};

// The choices of the run: those of the command line, or those of the line that repeats the sweep's case. Throws
// InputError when the file is none, is a record, or is a case that passed.
RunChoices failing_case(const ShrinkOptions& options);

}  // namespace kadans
