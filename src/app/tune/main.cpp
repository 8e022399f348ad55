// The program kadans-tune, by which `kadans tune` replaces itself.
#include <cstdio>
#include <exception>

#include <CLI/CLI.hpp>

#include "app/terminal.h"
#include "tuning.h"

namespace kadans {
namespace {

int run(int argc, char** argv) {
  CLI::App app("Kadans: the program behind `kadans tune`", "kadans");
  app.require_subcommand(1);
  TuneOptions options;
  add_tune(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    print_error(error.what());
    return exit_usage;
  }
  catch_interrupts();
  return Tuning(options).run();
}

}  // namespace
}  // namespace kadans

int main(int argc, char** argv) {
  return kadans::ended_well([&] { return kadans::run(argc, argv); });
}
