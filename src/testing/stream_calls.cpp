// The streams of the C library. The C++ streams use these, or the calls by descriptor, and pass here too.
#include <cstdarg>
#include <cstddef>
#include <cstdio>

#include "forbidden_call.h"

namespace kadans::testing {

void link_stream_calls() noexcept {}

}  // namespace kadans::testing

#if !KADANS_SANITIZER
// Variable arguments go on as a list, to the function that takes one.
#define KADANS_FORBID_PRINT(name, list_name, parameters, last, ...) \
  extern "C" int forbidden_##name parameters __asm__(#name);        \
  extern "C" int forbidden_##name parameters {                      \
    kadans::testing::forbid(#name);                                 \
    va_list more;                                                   \
    va_start(more, last);                                           \
    const int written = list_name(__VA_ARGS__, more);               \
    va_end(more);                                                   \
    return written;                                                 \
  }

KADANS_FORBID(int, vfprintf, (FILE * stream, const char* format, va_list more), stream, format, more)
KADANS_FORBID(int, vprintf, (const char* format, va_list more), format, more)
KADANS_FORBID_PRINT(printf, forbidden_vprintf, (const char* format, ...), format, format)
KADANS_FORBID_PRINT(fprintf, forbidden_vfprintf, (FILE * stream, const char* format, ...), format, stream, format)
KADANS_FORBID_PRINT(__printf_chk, forbidden_vprintf, (int, const char* format, ...), format, format)
KADANS_FORBID_PRINT(__fprintf_chk, forbidden_vfprintf, (FILE * stream, int, const char* format, ...), format, stream,
                    format)
KADANS_FORBID(FILE*, fopen, (const char* path, const char* mode), path, mode)
KADANS_FORBID(FILE*, fopen64, (const char* path, const char* mode), path, mode)
KADANS_FORBID(FILE*, freopen, (const char* path, const char* mode, FILE* stream), path, mode, stream)
KADANS_FORBID(FILE*, fdopen, (int file, const char* mode), file, mode)
KADANS_FORBID(int, fclose, (FILE * stream), stream)
KADANS_FORBID(int, fflush, (FILE * stream), stream)
KADANS_FORBID(std::size_t, fread, (void* data, std::size_t size, std::size_t count, FILE* stream), data, size, count,
              stream)
KADANS_FORBID(std::size_t, fwrite, (const void* data, std::size_t size, std::size_t count, FILE* stream), data, size,
              count, stream)
KADANS_FORBID(std::size_t, fwrite_unlocked, (const void* data, std::size_t size, std::size_t count, FILE* stream), data,
              size, count, stream)
KADANS_FORBID(char*, fgets, (char* line, int size, FILE* stream), line, size, stream)
KADANS_FORBID(int, fgetc, (FILE * stream), stream)
KADANS_FORBID(int, getc, (FILE * stream), stream)
KADANS_FORBID(int, fputs, (const char* text, FILE* stream), text, stream)
KADANS_FORBID(int, puts, (const char* text), text)
KADANS_FORBID(int, fputc, (int letter, FILE* stream), letter, stream)
KADANS_FORBID(int, putc, (int letter, FILE* stream), letter, stream)
KADANS_FORBID(int, putchar, (int letter), letter)
KADANS_FORBID(int, fseek, (FILE * stream, long to, int from), stream, to, from)
KADANS_FORBID(int, remove, (const char* path), path)
#endif
