#include "lua_state.h"

#include <algorithm>
#include <climits>
#include <new>

#include "engine/behavior_inputs.h"
#include "kadans/signal/input_error.h"
#include "lua_core.h"
#include "script/check/source_lexer.h"
#include "script/check/syntax_hint.h"
#include "script/sandbox/sandbox.h"
#include "signal/input_file.h"
#include "signal/monotonic_clock.h"

namespace kadans {
namespace {

constexpr std::uint64_t collect_bytes_min = 2048;
constexpr std::size_t source_bytes_max = std::size_t{1} << 20;

void* allocate(void* user, void* block, std::size_t old_bytes, std::size_t new_bytes) {
  auto& core = *static_cast<LuaCore*>(user);
  const bool had = core.heap.exceeded();
  void* moved = core.heap.reallocate(block, old_bytes, new_bytes);
  if (new_bytes > 0 && !had && core.heap.exceeded() && core.main != nullptr) {
    core.budget.memory_ran_out(core.running != nullptr ? core.running : core.main, moved != nullptr);
  }
  return moved;
}

// Gives a source to the compiler a piece at a time, each charged, so that one which takes long to compile can be
// stopped.
struct Pieces {
  static constexpr std::size_t bytes_max = 256;
  std::string_view left;
};

const char* next_piece(lua_State* state, void* user, std::size_t* size) {
  auto& pieces = *static_cast<Pieces*>(user);
  const std::string_view piece = pieces.left.substr(0, Pieces::bytes_max);
  pieces.left.remove_prefix(piece.size());
  *size = piece.size();
  core_of(state).budget.charge(state, compiling_instructions(static_cast<double>(piece.size())));
  return piece.data();
}

// The handler of uncaught errors: keeps the message and the stack while it still stands.
int keep_error(lua_State* state) {
  ScriptError& error = core_of(state).error;
  if (error.set) return 1;
  if (lua_type(state, 1) == LUA_TSTRING) {
    error.set_message(lua_tostring(state, 1));
  } else {
    error.set_message("the script raised a value that is not a string");
  }
  if (error.line == 0) note_place(state, error);
  error.add_hint(core_of(state).loading);
  luaL_traceback(state, state, nullptr, 1);
  error.set_traceback(lua_tostring(state, -1));
  if (LineWatch* watch = core_of(state).budget.watch()) watch->raised(state, error.message.data());
  return 1;
}

// The message of the compiler at the top of the stack goes on with what was meant, at the line to change.
void explain(lua_State* state, const std::string& text) {
  core_of(state).budget.charge(state, compiling_instructions(static_cast<double>(text.size())));
  ScriptError error;
  error.set_message(lua_tostring(state, -1));
  const SyntaxHint hint = syntax_hint(text, error.line, error.message.data());
  if (error.line == 0 || hint.text[0] == '\0') return;
  lua_pop(state, 1);
  lua_pushfstring(state, "%s:%d: %s: %s", error.file.data(), hint.line, error.message.data(), hint.text.data());
}

int enter(lua_State* state) { return core_of(state).entry(state); }

// At the foot of the stack for good, so that a call allocates nothing and looks nothing up.
enum Foot : int { handler = 1, entrance = 2 };

int open(lua_State* state) {
  lua_pushcfunction(state, keep_error);
  core_of(state).handler = luaL_ref(state, LUA_REGISTRYINDEX);
  open_sandbox(state);
  return 0;
}

}  // namespace

LuaState::LuaState(Settings settings)
    : settings_(std::move(settings)),
      core_(new LuaCore{.heap = LuaHeap(settings_.limits.memory_bytes, settings_.limits.block_bytes),
                        .limits = settings_.limits,
                        .random = RandomStream(settings_.seed, "script." + settings_.name)}) {
  core_->owner = this;
  lua_ = lua_newstate(allocate, core_.get());
  if (lua_ == nullptr) throw std::bad_alloc();
  core_->main = lua_;
  core_->heap.for_ticks(false);
  luaJIT_setmode(lua_, 0, LUAJIT_MODE_ENGINE | LUAJIT_MODE_OFF);
  lua_gc(lua_, LUA_GCSTOP, 0);
  lua_pushcfunction(lua_, keep_error);
  lua_pushcfunction(lua_, enter);
  if (!call(open, nullptr, settings_.limits.load_instructions, 0)) {
    lua_close(lua_);
    throw std::bad_alloc();
  }
}

LuaState::~LuaState() {
  core_->main = nullptr;
  lua_sethook(lua_, nullptr, 0, 0);
  lua_close(lua_);
}

const ScriptError& LuaState::error() const noexcept { return core_->error; }
std::size_t LuaState::used_bytes() const noexcept { return core_->heap.used_bytes(); }

bool LuaState::call(int (*function)(lua_State*), void* argument, std::uint64_t instructions,
                    std::int64_t wall_ns) noexcept {
  core_->depth = core_->coroutines = 0;
  core_->running = nullptr;
  core_->budget.begin(lua_, instructions, wall_ns);
  core_->entry = function;
  lua_settop(lua_, entrance);
  lua_pushvalue(lua_, entrance);
  lua_pushlightuserdata(lua_, argument);
  const int status = lua_pcall(lua_, 1, 0, handler);
  core_->running = nullptr;
  if (status != 0 && !core_->error.set) {
    const char* text = lua_tostring(lua_, -1);
    core_->error.set_message(text != nullptr ? text : "stopped");
  }
  lua_settop(lua_, entrance);
  return status == 0 && !core_->budget.breached();
}

void* LuaState::argument_of(lua_State* state) noexcept { return lua_touserdata(state, 1); }

void LuaState::throw_error() const { throw InputError({error().file.data(), error().line, 0, error().message.data()}); }

bool LuaState::load_file(lua_State* state, const std::filesystem::path& path) {
  Source source;
  source.path = path;
  source.chunk = path.lexically_relative(settings_.root).generic_string();
  if (source.chunk.empty() || source.chunk.starts_with("..")) source.chunk = path.generic_string();
  const std::string chunk = "@" + source.chunk;
  try {
    source.text = read_input_file(path, source_bytes_max);
    if (BehaviorInputs* const inputs = settings_.limits.inputs_now(); inputs != nullptr)
      inputs->file_read(path.string(), source.text);
  } catch (const InputError& error) {
    lua_pushfstring(state, "%s:1: %s", source.chunk.c_str(), error.problems().front().message.c_str());
    return false;
  }
  if (source.text.starts_with('\x1b')) {
    lua_pushfstring(state, "%s:1: is bytecode; scripts are text", source.chunk.c_str());
    return false;
  }
  sources_.push_back(std::move(source));
  Pieces pieces{sources_.back().text};
  const int status = lua_loadx(state, next_piece, &pieces, chunk.c_str(), "t");
  if (status == LUA_ERRSYNTAX) explain(state, sources_.back().text);
  if (status != 0) return false;
  push_environment(lua_);
  lua_setfenv(state, -2);
  return true;
}

std::filesystem::path LuaState::find_module(std::string_view name) const {
  std::string relative;
  bool start = true;  // of a part: a part begins with a letter or digit, so ".." and "/" find nothing
  for (const char c : name) {
    const bool word = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    if (!word && (c != '.' || start)) return {};
    relative += word ? c : '/';
    start = !word;
  }
  if (start) return {};
  relative += ".lua";
  for (const auto& folder : {settings_.folder, settings_.root / "behaviors/lib"}) {
    std::error_code ignored;
    if (std::filesystem::is_regular_file(folder / relative, ignored)) return folder / relative;
  }
  return {};
}

std::vector<std::string> LuaState::module_names() const {
  constexpr std::size_t names_max = 64;
  std::vector<std::string> names;
  for (const auto& folder : {settings_.folder, settings_.root / "behaviors/lib"}) {
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
      if (names.size() == names_max) return names;
      if (entry.path().extension() == ".lua") names.push_back(entry.path().stem().string());
    }
  }
  return names;
}

std::string_view LuaState::text_of(std::string_view chunk) const noexcept {
  const auto source = std::ranges::find(sources_, chunk, &Source::chunk);
  return source == sources_.end() ? std::string_view{} : source->text;
}

std::string_view LuaState::line_text(std::string_view chunk, int line) const noexcept {
  return line_of_text(text_of(chunk), line);
}

int LuaState::line_of(std::string_view chunk, int from, std::string_view text) const {
  const std::string_view all = text_of(chunk);
  const char* const first = line_of_text(all, from).data();  // nullptr: there is no such line
  const std::size_t start = first == nullptr ? std::string_view::npos : static_cast<std::size_t>(first - all.data());
  for (std::size_t at = all.find(text, start); at != std::string_view::npos; at = all.find(text, at + 1)) {
    const std::size_t end = at + text.size();
    if ((at > 0 && in_name(all[at - 1])) || (end < all.size() && in_name(all[end]))) continue;
    return from + static_cast<int>(std::ranges::count(all.substr(start, at - start), '\n'));
  }
  return from;
}

double LuaState::search_instructions(std::string_view chunk) const noexcept {
  constexpr double bytes_per_instruction = 32;
  return static_cast<double>(text_of(chunk).size()) / bytes_per_instruction;
}

void LuaState::collect() noexcept {
  const std::uint64_t fresh = core_->heap.allocated_bytes() - collected_at_;
  if (fresh < collect_bytes_min) return;  // it adds up over the ticks
  collected_at_ = core_->heap.allocated_bytes();
  const bool all = core_->heap.used_bytes() > settings_.limits.memory_bytes / 4 * 3;
  if (settings_.limits.tick_wall_ns > 0) {
    collect_in_time(all ? INT_MAX : static_cast<int>(std::min<std::uint64_t>(fresh / 256, INT_MAX)));
  } else if (all) {
    lua_gc(lua_, LUA_GCCOLLECT, 0);
  } else {
    lua_gc(lua_, LUA_GCSTEP, static_cast<int>(fresh / 256));
  }
  lua_gc(lua_, LUA_GCSTOP, 0);  // a step starts the collector again
}

// In pieces of some 0.1 ms: a whole collection of 4 MB takes 10 ms. By the thread's own time, as a tick's budget.
void LuaState::collect_in_time(int kB) noexcept {
  constexpr int piece_kB = 32;
  for (std::int64_t end_ns = 0; kB > 0; kB -= piece_kB) {
    if (lua_gc(lua_, LUA_GCSTEP, std::min(kB, piece_kB)) != 0 || kB <= piece_kB) return;
    const std::int64_t now_ns = thread_cpu_ns();
    if (end_ns == 0) end_ns = now_ns + settings_.limits.tick_wall_ns;
    if (now_ns >= end_ns) return;
  }
}

}  // namespace kadans
