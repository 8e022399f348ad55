// `kadans ctl repl`: a console whose lines run in a running instance, between the ticks of its behaviors.
#pragma once

#include "kadans/remote/ctl_link.h"

namespace kadans {

// From a terminal with editing and completion; from a pipe line by line, a wrong one makes the exit code 1.
int ctl_console(CtlLink& link);

}  // namespace kadans
