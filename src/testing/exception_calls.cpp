// Exceptions: forbidden to marked threads from the moment memory is asked for one, so that the report says throw.
#include <cstddef>
#include <typeinfo>

#include "forbidden_call.h"

namespace kadans::testing {

void link_exception_calls() noexcept {}

}  // namespace kadans::testing

#if !KADANS_SANITIZER
using Destructor = void (*)(void*);

KADANS_FORBID(void*, __cxa_allocate_exception, (std::size_t size), size)
KADANS_FORBID(void, __cxa_throw, (void* exception, std::type_info* type, Destructor destructor), exception, type,
              destructor)
KADANS_FORBID(void, __cxa_rethrow, (), )
#endif
