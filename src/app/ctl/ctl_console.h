// `kadans ctl repl`: a console whose lines are evaluated in a running instance, between the ticks of its behaviors.
#pragma once

#include "remote/ctl/ctl_folder.h"

namespace kadans {

// On a terminal it has editing and completion. From a pipe it reads line by line, and a wrong line makes the exit code
// 1.
int ctl_console(CtlLink& link);

}  // namespace kadans
