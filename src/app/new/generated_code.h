// C code that a tool has made of a controller, as a person copies it from there: which shape it has, and what its own
// tables say of inputs, outputs and parameters.
//
// - 20-sim: XXInitializeSubmodel(u, y, t), XXCalculateSubmodel and XXTerminateSubmodel, and names with X before or
//   behind. Tables: xx_input_names, xx_output_names and xx_parameter_names, which may stand in a comment; else the
//   comments beside u[0] and y[0].
// - Simulink Coder: MODEL_initialize(void), MODEL_step(void) and MODEL_terminate(void). Tables: the structs of MODEL_U,
//   MODEL_Y and MODEL_P.
// - OpenModelica, a source FMU (FMI 2.0, co-simulation): modelDescription.xml and fmi2DoStep. Tables: its
//   ScalarVariables.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kadans {

struct CodeValue {
  std::string name;    // words of a-z, A-Z, 0-9 and _ joined by dots
  std::string access;  // "model_U.reference", "xx_P[3]"; of an FMU its value reference
  std::string unit{}, doc{};
};

struct GeneratedCode {
  enum class Shape : std::uint8_t { twenty_sim, simulink, fmu };
  Shape shape = Shape::twenty_sim;
  std::string tool;            // for people
  std::string header;          // that declares its functions; of an FMU: none
  std::string before, behind;  // what stands in the names of its functions before and behind the words of the shape
  std::string guid;            // of an FMU
  double step_s = 0;           // 0: the code does not say it; an FMU is stepped as long as it is told
  std::vector<CodeValue> inputs, outputs, parameters;
  std::vector<std::filesystem::path> sources, others;  // to be compiled; headers and what else is included
};

// Reads all .c, .h and .xml files of the folder and of those in it. Throws InputError that names the file, what was
// looked for and what was found, when they have none of the shapes or only half of one.
GeneratedCode read_generated_code(const std::filesystem::path& folder);

}  // namespace kadans
