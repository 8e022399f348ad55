// The verbs of `kadans log`, and what they share: spans of time, files that are not written over by mistake, lines for
// whoever reads them.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "kadans/telemetry/record_outline.h"
#include "log/log_command.h"

namespace kadans {

int log_info(const LogOptions& options);
int log_cat(const LogOptions& options);
int log_csv(const LogOptions& options);
int log_plot(const LogOptions& options);
int log_diff(const LogOptions& options);
int log_cut(const LogOptions& options);

// Of --from and --to. Throws InputError when they do not make a span.
TimeSpan span_of(const LogOptions& options);
// Throws InputError when the span lies outside the record's time.
void require_overlap(const RecordOutline& record, TimeSpan span);
// A record that was cut short is read as far as it goes, and that is told on stderr.
void tell_problem(const McapReader& reader);
void tell_problem(const RecordOutline& record);
std::string plural(std::uint64_t count, const char* what);

// Throws InputError when the file that is to be written is there already and --force was not given, or is the record.
void require_free(const LogOptions& options);

// Under a temporary name until it is whole; a device or pipe is written to as it is.
class UnfinishedFile {
 public:
  explicit UnfinishedFile(const std::filesystem::path& file);  // throws InputError
  ~UnfinishedFile();                                           // removes what was not finished
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

  std::string path() const { return unfinished_.string(); }
  void finish();  // throws InputError

 private:
  std::filesystem::path file_, unfinished_;
  bool finished_ = false;
};

// Lines into a file or onto stdout, whose reader may have had enough.
class LineOutput {
 public:
  explicit LineOutput(const std::string& file);  // "": stdout
  ~LineOutput();
  LineOutput(const LineOutput&) = delete;
  LineOutput& operator=(const LineOutput&) = delete;

  // False: nobody reads on. Throws InputError when it cannot be written.
  [[nodiscard]] bool put(std::string_view line);
  void finish();

 private:
  [[nodiscard]] bool failed() const;

  std::unique_ptr<UnfinishedFile> unfinished_;
  std::FILE* stream_;
  std::string name_;
};

}  // namespace kadans
