// Every `new` of the program goes through here. Built with AddressSanitizer its hooks count what libraries allocate by
// malloc as well.
#include "memory.h"

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <malloc.h>
#include <new>

#if defined(__SANITIZE_ADDRESS__)
extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*on_malloc)(const volatile void*, std::size_t),
                                                         void (*on_free)(const volatile void*));
extern "C" std::size_t __sanitizer_get_allocated_size(const volatile void*);
// Too large a request is answered with null rather than an abort, so that it is counted and handled like any other.
extern "C" const char* __asan_default_options() {
    return "detect_leaks=0:allocator_may_return_null=1:max_allocation_size_mb=8192:quarantine_size_mb=64";
}
extern "C" const char* __ubsan_default_options() {
    return "print_stacktrace=1";
}
#endif

namespace vkvol::fuzz {

namespace {

std::atomic<bool> counting{false};
std::atomic<std::int64_t> live{0}, peak{0};
std::atomic<std::uint64_t> bound{0}, refused{0};

void add(std::int64_t bytes) {
    const std::int64_t now = live += bytes;
    for (std::int64_t seen = peak; now > seen && !peak.compare_exchange_weak(seen, now);) {
    }
    if (counting && now > 0 && static_cast<std::uint64_t>(now) > bound && refused == 0)
        refused = static_cast<std::uint64_t>(bytes);
}

[[maybe_unused]] void remove(std::int64_t bytes) {
    live -= bytes;
}

#if defined(__SANITIZE_ADDRESS__)
[[maybe_unused]] const int hooks = __sanitizer_install_malloc_and_free_hooks(
    [](const volatile void*, std::size_t size) { add(static_cast<std::int64_t>(size)); },
    [](const volatile void* p) { remove(static_cast<std::int64_t>(__sanitizer_get_allocated_size(p))); });
constexpr bool hooked = true;
#else
constexpr bool hooked = false;
#endif

bool refuse(std::size_t size) {
    const std::int64_t now = live;
    if (!counting || static_cast<std::uint64_t>(now > 0 ? now : 0) + size <= bound)
        return false;
    if (refused == 0)
        refused = size;
    return true;
}

void* allocate(std::size_t size, std::size_t alignment) {
    if (refuse(size))
        return nullptr;
    void* p = alignment > alignof(std::max_align_t)
                  ? std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment)
                  : std::malloc(size > 0 ? size : 1);
    if (p && !hooked)
        add(static_cast<std::int64_t>(malloc_usable_size(p)));
    return p;
}

void* allocate_or_throw(std::size_t size, std::size_t alignment) {
    void* p = allocate(size, alignment);
    if (!p)
        throw std::bad_alloc();
    return p;
}

void release(void* p) {
    if (p && !hooked)
        remove(static_cast<std::int64_t>(malloc_usable_size(p)));
    std::free(p);
}

} // namespace

void begin_counting(std::uint64_t most) {
    live = 0;
    peak = 0;
    refused = 0;
    bound = most;
    counting = true;
}

void end_counting() {
    counting = false;
}

std::uint64_t peak_bytes() {
    return static_cast<std::uint64_t>(peak.load());
}

std::uint64_t refused_bytes() {
    return refused;
}

} // namespace vkvol::fuzz

using vkvol::fuzz::allocate;
using vkvol::fuzz::allocate_or_throw;
using vkvol::fuzz::release;

void* operator new(std::size_t size) {
    return allocate_or_throw(size, 0);
}
void* operator new[](std::size_t size) {
    return allocate_or_throw(size, 0);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
    return allocate_or_throw(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
    return allocate_or_throw(size, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    return allocate(size, 0);
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
    return allocate(size, 0);
}
void operator delete(void* p) noexcept {
    release(p);
}
void operator delete[](void* p) noexcept {
    release(p);
}
void operator delete(void* p, std::size_t) noexcept {
    release(p);
}
void operator delete[](void* p, std::size_t) noexcept {
    release(p);
}
void operator delete(void* p, std::align_val_t) noexcept {
    release(p);
}
void operator delete[](void* p, std::align_val_t) noexcept {
    release(p);
}
void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
    release(p);
}
void operator delete[](void* p, std::size_t, std::align_val_t) noexcept {
    release(p);
}
void operator delete(void* p, const std::nothrow_t&) noexcept {
    release(p);
}
void operator delete[](void* p, const std::nothrow_t&) noexcept {
    release(p);
}
