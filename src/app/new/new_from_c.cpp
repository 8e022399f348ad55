// `kadans new control-object NAME --from-c FOLDER`: a control object around C code that a tool has made. In the
// templates @type@ and @Name@ stand for its names, the others for what the code's own tables say.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>

#include "app/terminal.h"
#include "generated_code.h"
#include "new_files.h"
#include "signal/input_file.h"
#include "signal/number_text.h"
#include "wrapped_object.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view wrapped_cmake_template = R"(cmake_minimum_required(VERSION 3.25)
project(@type@ LANGUAGES C CXX)
if(NOT TARGET kadans::kadans)
  find_package(kadans 0.2 REQUIRED)
endif()
enable_testing()

# The C code as it came, and what calls it.
add_library(@type@_code OBJECT @type@_code.c@sources@)
target_include_directories(@type@_code PRIVATE@folders@)
set_target_properties(@type@_code PROPERTIES POSITION_INDEPENDENT_CODE ON C_VISIBILITY_PRESET hidden)

# Which variables of it a program has once: read from what the compiler made of it.
set(@type@_state "${CMAKE_CURRENT_BINARY_DIR}/@type@_state.h")
add_custom_command(OUTPUT "${@type@_state}"
  COMMAND "${CMAKE_COMMAND}" "-DOBJDUMP=${CMAKE_OBJDUMP}" "-DOBJECTS=$<JOIN:$<TARGET_OBJECTS:@type@_code>,|>"
          "-DTO=${@type@_state}" -P "${CMAKE_CURRENT_SOURCE_DIR}/state.cmake"
  DEPENDS @type@_code $<TARGET_OBJECTS:@type@_code> state.cmake VERBATIM)

add_executable(@type@_test @type@.cpp @type@_test.cpp $<TARGET_OBJECTS:@type@_code> "${@type@_state}")
target_include_directories(@type@_test PRIVATE "${CMAKE_CURRENT_BINARY_DIR}")
target_link_libraries(@type@_test PRIVATE kadans::testing kadans::control m)
add_test(NAME @type@ COMMAND @type@_test)
)";

constexpr std::string_view wrapped_cmake_plugin = R"(
kadans_plugin(@type@ SOURCES plugin.cpp @type@.cpp $<TARGET_OBJECTS:@type@_code> "${@type@_state}")
target_include_directories(@type@ PRIVATE "${CMAKE_CURRENT_BINARY_DIR}")
)";

constexpr std::string_view wrapped_cmake_program = R"(
# The program with the new type in it: build/kadans_@type@ sim SCENARIO
add_executable(kadans_@type@ main.cpp @type@.cpp $<TARGET_OBJECTS:@type@_code> "${@type@_state}")
target_include_directories(kadans_@type@ PRIVATE "${CMAKE_CURRENT_BINARY_DIR}")
target_link_libraries(kadans_@type@ PRIVATE kadans::kadans)
)";

constexpr std::string_view state_cmake =
    R"(# Writes a header with the names of the variables in writable memory, static and global, of these object files.
string(REPLACE "|" ";" objects "${OBJECTS}")
set(names)
foreach(object IN LISTS objects)
  execute_process(COMMAND "${OBJDUMP}" -t "${object}" OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCHALL "O (\\.bss|\\.data|\\.tbss|\\.tdata|\\*COM\\*)[^\t\n]*\t[0-9a-f]+ [^\n]*" rows "${symbols}")
  foreach(row IN LISTS rows)
    if(NOT row MATCHES "^O \\.data\\.rel\\.ro")
      string(REGEX REPLACE "^.*[ \t]" "" name "${row}")
      list(APPEND names "${name}")
    endif()
  endforeach()
endforeach()
list(LENGTH names count)
if(count GREATER 6)
  list(SUBLIST names 0 6 names)
  list(APPEND names "...")
endif()
list(JOIN names ", " text)
file(WRITE "${TO}" "inline constexpr const char* shared_state = \"${text}\";\n")
)";

constexpr std::string_view code_header_template = R"(/* What @type@.cpp calls of the C code. */
enum { @type@_inputs = @inputs@, @type@_outputs = @outputs@, @type@_parameters = @parameters@ };

/* NULL: it cannot be made. */
void *@type@_make(void);
void @type@_free(void *code);
/* Begins anew. With `read`, parameters are filled with the code's own values, else the code gets these. */
void @type@_initialise(void *code, double *parameters, int read);
void @type@_step(void *code, double time_s, double step_s, const double *inputs, double *outputs,
                 const double *parameters);
)";

constexpr std::string_view twenty_sim_template = R"(/* Calls the code of a 20-sim submodel. */
#include "@type@_code.h"

#include "@header@"

@externs@
static XXDouble u[@type@_inputs], y[@type@_outputs];

void *@type@_make(void) { return u; }

void @type@_free(void *code) {
  (void)code;
  @before@TerminateSubmodel@behind@(u, y, 0);
}

void @type@_initialise(void *code, double *parameters, int read) {
  int i;
  (void)code;
  for (i = 0; i < @type@_inputs; ++i) u[i] = 0;
  for (i = 0; i < @type@_outputs; ++i) y[i] = 0;
  @before@InitializeSubmodel@behind@(u, y, 0);
  if (read) {
@read_parameters@  } else {
@write_parameters_there@  }
  (void)parameters;
}

void @type@_step(void *code, double time_s, double step_s, const double *inputs, double *outputs,
                 const double *parameters) {
  int i;
  (void)code, (void)step_s, (void)parameters;
  for (i = 0; i < @type@_inputs; ++i) u[i] = inputs[i];
@write_parameters@  @before@CalculateSubmodel@behind@(u, y, time_s);
  for (i = 0; i < @type@_outputs; ++i) outputs[i] = y[i];
}
)";

constexpr std::string_view simulink_template = R"(/* Calls the code of a Simulink model. */
#include "@type@_code.h"

#include "@header@"

static int made;

void *@type@_make(void) { return &made; }

void @type@_free(void *code) {
  (void)code;
  @before@_terminate();
}

void @type@_initialise(void *code, double *parameters, int read) {
  (void)code, (void)parameters;
  if (read) {
@read_parameters@  } else {
@write_parameters_there@  }
  @before@_initialize();
}

void @type@_step(void *code, double time_s, double step_s, const double *inputs, double *outputs,
                 const double *parameters) {
  (void)code, (void)time_s, (void)step_s, (void)parameters;
@write_inputs@@write_parameters@  @before@_step();
@read_outputs@}
)";

// The types and functions of FMI 2.0 (fmi-standard.org), as far as they are called.
constexpr std::string_view fmu_template = R"(/* Calls the sources of an FMU: FMI 2.0 for co-simulation. */
#include "@type@_code.h"

#include <stdlib.h>

typedef struct {
  void (*logger)(void *environment, const char *instance, int status, const char *category, const char *message, ...);
  void *(*allocate)(size_t count, size_t size);
  void (*release)(void *memory);
  void (*finished)(void *environment, int status);
  void *environment;
} Callbacks;

void *@before@fmi2Instantiate(const char *name, int type, const char *guid, const char *resources,
                              const Callbacks *callbacks, int visible, int logging);
void @before@fmi2FreeInstance(void *code);
int @before@fmi2SetupExperiment(void *code, int tolerance_given, double tolerance, double start_s, int stop_given,
                                double stop_s);
int @before@fmi2EnterInitializationMode(void *code);
int @before@fmi2ExitInitializationMode(void *code);
int @before@fmi2Terminate(void *code);
int @before@fmi2Reset(void *code);
int @before@fmi2GetReal(void *code, const unsigned *references, size_t count, double *values);
int @before@fmi2SetReal(void *code, const unsigned *references, size_t count, const double *values);
int @before@fmi2DoStep(void *code, double time_s, double step_s, int no_return);

static const unsigned input_references[] = {@input_references@};
static const unsigned output_references[] = {@output_references@};
static const unsigned parameter_references[] = {@parameter_references@0};

static void no_logger(void *environment, const char *instance, int status, const char *category, const char *message,
                      ...) {
  (void)environment, (void)instance, (void)status, (void)category, (void)message;
}
static const Callbacks callbacks = {no_logger, calloc, free, NULL, NULL};

void *@type@_make(void) {
  return @before@fmi2Instantiate("@type@", 1, @guid@, "", &callbacks, 0, 0);
}

void @type@_free(void *code) {
  @before@fmi2Terminate(code);
  @before@fmi2FreeInstance(code);
}

void @type@_initialise(void *code, double *parameters, int read) {
  if (read) {
    @before@fmi2GetReal(code, parameter_references, @type@_parameters, parameters);
  } else {
    @before@fmi2Reset(code);
    @before@fmi2SetReal(code, parameter_references, @type@_parameters, parameters);
  }
  @before@fmi2SetupExperiment(code, 0, 0, 0, 0, 0);
  @before@fmi2EnterInitializationMode(code);
  @before@fmi2ExitInitializationMode(code);
}

void @type@_step(void *code, double time_s, double step_s, const double *inputs, double *outputs,
                 const double *parameters) {
  @before@fmi2SetReal(code, input_references, @type@_inputs, inputs);
  @before@fmi2SetReal(code, parameter_references, @type@_parameters, parameters);
  @before@fmi2DoStep(code, time_s, step_s, 1);
  @before@fmi2GetReal(code, output_references, @type@_outputs, outputs);
}
)";

std::string table_rows(const std::vector<CodeValue>& values, const char* what) {
  std::string text;
  for (const CodeValue& value : values) {
    const std::string doc = value.doc.empty() ? what + value.name + "." : value.doc;
    text += "    {" + source_text(value.name) + ", " + source_text(value.unit) + ", -1e6, 1e6, " + source_text(doc) +
            "},\n";
  }
  return text;
}

// "  xx_P[0] = parameters[0];\n" and so on; or the other way round.
std::string assignments(const std::vector<CodeValue>& values, const std::string& array, bool to_code,
                        const char* indent = "  ") {
  std::string text;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string element = array + "[" + std::to_string(i) + "]", &access = values[i].access;
    text += indent + (to_code ? access + " = " + element : element + " = " + access) + ";\n";
  }
  return text;
}

std::string value_references(const std::vector<CodeValue>& values, bool more) {
  std::string text;
  for (std::size_t i = 0; i < values.size(); ++i) text += (i > 0 ? ", " : "") + values[i].access + "u";
  return text + (more && !values.empty() ? ", " : "");
}

std::string decimal(double value) { return printed("%.9g", value); }

// The parameter array, where the code's headers do not declare it.
std::string outer_arrays(const GeneratedCode& code) {
  if (code.parameters.empty()) return "";
  const std::string& access = code.parameters.front().access;
  return "extern XXDouble " + access.substr(0, access.find('[')) + "[];\n";
}

std::string_view adapter_template(GeneratedCode::Shape shape) {
  if (shape == GeneratedCode::Shape::twenty_sim) return twenty_sim_template;
  return shape == GeneratedCode::Shape::simulink ? simulink_template : fmu_template;
}

std::string example_options(const GeneratedCode& code) {
  std::string text;
  for (const CodeValue& value : code.inputs) text += (text.empty() ? "" : ", ") + source_text(value.name) + ": \"...\"";
  for (const CodeValue& value : code.outputs) text += ", " + source_text(value.name) + ": \"...\"";
  return text;
}

}  // namespace

int run_new_from_c(const NewControlObjectOptions& options, std::string_view main_template) {
  GeneratedCode code = read_generated_code(options.from_c);
  const bool any_step = code.shape == GeneratedCode::Shape::fmu;
  if (options.period_s) code.step_s = *options.period_s;
  if (!any_step && !(code.step_s > 0))
    refuse(options.from_c,
           "does not say how often a step of it is taken: looked for xx_step_size = ... (20-sim), "
           "stepSize0 = ... and \"Sample time: [...s\" (Simulink Coder), found none; give it by "
           "--period S");
  const std::string& type = options.name;
  const fs::path folder = fs::path(options.folder) / type;
  std::vector<NewFile> files;
  std::string sources;
  std::vector<fs::path> folders{""};
  const auto copy = [&](const fs::path& file) {
    const fs::path within = file.lexically_relative(options.from_c);
    files.push_back({folder / "code" / within, read_input_file(file.string())});
    if (std::ranges::find(folders, within.parent_path()) == folders.end()) folders.push_back(within.parent_path());
    return "code/" + within.string();
  };
  for (const fs::path& file : code.sources) sources += " \"" + copy(file) + "\"";
  for (const fs::path& file : code.others) copy(file);
  std::string includes;
  for (const fs::path& one : folders) includes += " \"${CMAKE_CURRENT_SOURCE_DIR}/" + ("code" / one).string() + "\"";

  const std::string write = assignments(code.parameters, "parameters", true);
  const std::vector<std::pair<std::string, std::string>> values{
      {"@type@", type},
      {"@Name@", class_name_of(type)},
      {"@tool@", code.tool},
      {"@every@", code.step_s > 0 ? decimal(code.step_s) + " s" : "tick"},
      {"@period@", code.step_s > 0 ? decimal(code.step_s) : "0"},
      {"@input_rows@", table_rows(code.inputs, "Input ")},
      {"@output_rows@", table_rows(code.outputs, "Output ")},
      {"@parameter_rows@", table_rows(code.parameters, "Parameter ")},
      {"@inputs@", std::to_string(code.inputs.size())},
      {"@outputs@", std::to_string(code.outputs.size())},
      {"@parameters@", std::to_string(code.parameters.size())},
      {"@sources@", sources},
      {"@folders@", includes},
      {"@header@", code.header},
      {"@before@", code.before},
      {"@behind@", code.behind},
      {"@guid@", source_text(code.guid)},
      {"@externs@", outer_arrays(code)},
      {"@read_parameters@", assignments(code.parameters, "parameters", false, "    ")},
      {"@write_parameters_there@", assignments(code.parameters, "parameters", true, "    ")},
      {"@write_parameters@", write},
      {"@write_inputs@", assignments(code.inputs, "inputs", true)},
      {"@read_outputs@", assignments(code.outputs, "outputs", false)},
      {"@input_references@", value_references(code.inputs, false)},
      {"@output_references@", value_references(code.outputs, false)},
      {"@parameter_references@", value_references(code.parameters, true)}};
  const auto add = [&](const std::string& name, std::string_view text) {
    files.push_back({folder / name, filled_template(text, values)});
  };
  add(type + ".h", wrapped_header_template);
  add(type + ".cpp", wrapped_source_template);
  add(type + "_code.h", code_header_template);
  add(type + "_code.c", adapter_template(code.shape));
  add(type + "_test.cpp", wrapped_test_template);
  add(options.plugin ? "plugin.cpp" : "main.cpp", main_template);
  add("CMakeLists.txt",
      std::string(wrapped_cmake_template) + std::string(options.plugin ? wrapped_cmake_plugin : wrapped_cmake_program));
  files.push_back({folder / "state.cmake", std::string(state_cmake)});
  write_new_files({folder}, files);
  std::fprintf(stderr, "%s: %zu inputs, %zu outputs, %zu parameters; a step every %s\n", code.tool.c_str(),
               code.inputs.size(), code.outputs.size(), code.parameters.size(),
               code.step_s > 0 ? (decimal(code.step_s) + " s").c_str() : "tick");
  tell_build(folder, type);
  std::fprintf(
      stderr,
      "Connect it:  in the robot's control.objects, { \"type\": \"%s\", \"options\": { %s } }; %s says to what\n",
      type.c_str(), example_options(code).c_str(), (folder / (type + ".h")).c_str());
  return exit_passed;
}

}  // namespace kadans
