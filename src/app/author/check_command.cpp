#include <CLI/CLI.hpp>

#include "app/commands.h"
#include "config/robot/mesh_hull.h"
#include "file_checks.h"
#include "robot_description.h"

namespace kadans {
namespace {

struct CheckOptions {
  std::vector<std::string> files;
  std::string robot;                  // configuration against which behaviors are checked; "": the one for their folder
  bool plugins = false;               // load plug-ins
  bool strict = false;                // warnings are mistakes
  std::vector<std::string> packages;  // "NAME=FOLDER", where a URDF's meshes are
};

int run_check(const CheckOptions& options) {
  const UrdfOptions urdf{.mesh_hull = mesh_hull,
                         .mesh_triangles = mesh_triangles,
                         .strict = options.strict,
                         .packages = packages_of(options.packages)};
  return FileChecks(options.robot, options.plugins, urdf).print_all(options.files, false);
}

}  // namespace

void add_check(CommandLine& line) {
  const auto [check, options] =
      line.add<CheckOptions>("check", "Report mistakes in files, without running them", run_check);
  check
      ->add_option(
          "files", options.files,
          "URDF, xacro or MJCF, robot, scenario or plan (JSON), behaviors, modules and tests (Lua); folders, patterns")
      ->required()
      ->type_name("PATH...");
  check
      ->add_option("--robot", options.robot, "Robot for which behaviors are checked (default: the one of their folder)")
      ->type_name("FILE");
  check->add_flag("--plugins", options.plugins,
                  "Load the plug-ins that robots name, and check what uses them; this runs code of the plug-ins");
  check->add_flag("--strict", options.strict, "Warnings of a URDF are mistakes");
  check->add_option("--package", options.packages, package_help)->type_name("NAME=FOLDER")->allow_extra_args(false);
}

}  // namespace kadans
