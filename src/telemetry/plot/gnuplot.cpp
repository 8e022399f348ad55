#include <system_error>

#include "kadans/signal/input_error.h"
#include "realtime/machine/child_process.h"
#include "signal_plot.h"

namespace kadans {

std::string draw(const SignalPlot& plot, PlotFormat format, PlotSize size) {
  ProgramOutput drawn;
  try {
    drawn = run_program({"gnuplot", "-d"}, gnuplot_script(plot, format, size));  // -d: nobody's settings but ours
  } catch (const std::system_error& error) {
    if (error.code() != std::errc::no_such_file_or_directory) throw;
    throw InputError({.message = "plots are drawn by gnuplot, which is not here: install the package gnuplot-nox"});
  }
  if (drawn.exit_code != 0 || drawn.out.empty())
    throw InputError({.message = "gnuplot failed: " + drawn.err.substr(0, 500)});
  return drawn.out;
}

}  // namespace kadans
