// Locks, threads and waiting.
#include <poll.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/epoll.h>
#include <sys/select.h>
#include <time.h>
#include <unistd.h>

#include "forbidden_call.h"

namespace kadans::testing {

void link_lock_calls() noexcept {}

}  // namespace kadans::testing

#if !KADANS_SANITIZER
using Time = const timespec*;
using ThreadMain = void* (*)(void*);

KADANS_FORBID(int, pthread_mutex_lock, (pthread_mutex_t * mutex), mutex)
KADANS_FORBID(int, pthread_mutex_trylock, (pthread_mutex_t * mutex), mutex)
KADANS_FORBID(int, pthread_mutex_timedlock, (pthread_mutex_t * mutex, Time until), mutex, until)
KADANS_FORBID(int, pthread_mutex_clocklock, (pthread_mutex_t * mutex, clockid_t clock, Time until), mutex, clock, until)
KADANS_FORBID(int, pthread_mutex_unlock, (pthread_mutex_t * mutex), mutex)
KADANS_FORBID(int, pthread_rwlock_rdlock, (pthread_rwlock_t * lock), lock)
KADANS_FORBID(int, pthread_rwlock_tryrdlock, (pthread_rwlock_t * lock), lock)
KADANS_FORBID(int, pthread_rwlock_wrlock, (pthread_rwlock_t * lock), lock)
KADANS_FORBID(int, pthread_rwlock_trywrlock, (pthread_rwlock_t * lock), lock)
KADANS_FORBID(int, pthread_rwlock_unlock, (pthread_rwlock_t * lock), lock)
KADANS_FORBID(int, pthread_spin_lock, (pthread_spinlock_t * lock), lock)
KADANS_FORBID(int, pthread_cond_wait, (pthread_cond_t * condition, pthread_mutex_t* mutex), condition, mutex)
KADANS_FORBID(int, pthread_cond_timedwait, (pthread_cond_t * condition, pthread_mutex_t* mutex, Time until), condition,
              mutex, until)
KADANS_FORBID(int, pthread_cond_clockwait,
              (pthread_cond_t * condition, pthread_mutex_t* mutex, clockid_t clock, Time until), condition, mutex,
              clock, until)
KADANS_FORBID(int, pthread_cond_signal, (pthread_cond_t * condition), condition)
KADANS_FORBID(int, pthread_cond_broadcast, (pthread_cond_t * condition), condition)
KADANS_FORBID(int, pthread_barrier_wait, (pthread_barrier_t * barrier), barrier)
KADANS_FORBID(int, pthread_create, (pthread_t * thread, const pthread_attr_t* attributes, ThreadMain run, void* with),
              thread, attributes, run, with)
KADANS_FORBID(int, pthread_join, (pthread_t thread, void** result), thread, result)
KADANS_FORBID(int, sem_wait, (sem_t * semaphore), semaphore)
KADANS_FORBID(int, sem_trywait, (sem_t * semaphore), semaphore)
KADANS_FORBID(int, sem_timedwait, (sem_t * semaphore, Time until), semaphore, until)
KADANS_FORBID(int, sem_clockwait, (sem_t * semaphore, clockid_t clock, Time until), semaphore, clock, until)
KADANS_FORBID(int, sem_post, (sem_t * semaphore), semaphore)

KADANS_FORBID(unsigned, sleep, (unsigned duration_s), duration_s)
KADANS_FORBID(int, usleep, (useconds_t duration_us), duration_us)
KADANS_FORBID(int, nanosleep, (Time duration, timespec* remaining), duration, remaining)
KADANS_FORBID(int, clock_nanosleep, (clockid_t clock, int flags, Time until, timespec* remaining), clock, flags, until,
              remaining)
KADANS_FORBID(int, sched_yield, (), )
KADANS_FORBID(int, poll, (pollfd * files, nfds_t count, int timeout_ms), files, count, timeout_ms)
KADANS_FORBID(int, select, (int count, fd_set* readable, fd_set* writable, fd_set* failed, timeval* timeout), count,
              readable, writable, failed, timeout)
KADANS_FORBID(int, epoll_wait, (int poller, epoll_event* events, int count, int timeout_ms), poller, events, count,
              timeout_ms)
#endif
