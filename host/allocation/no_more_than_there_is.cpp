// jemalloc takes address space without asking whether there is memory for it: what is more than a machine has would not
// fail, but the system would end the program later, without a word. Compiled into programs that link jemalloc.
#include <cstdlib>
#include <new>
#include <sys/sysinfo.h>

namespace {

std::size_t whole_memory() {
    struct sysinfo info {};
    return sysinfo(&info) == 0 ? (info.totalram + info.totalswap) * std::size_t{info.mem_unit} : ~std::size_t{0};
}

} // namespace

void* operator new(std::size_t size) {
    static const std::size_t most = whole_memory();
    while (true) {
        if (void* place = size <= most ? std::malloc(size > 0 ? size : 1) : nullptr)
            return place;
        const std::new_handler handler = std::get_new_handler();
        if (!handler)
            throw std::bad_alloc();
        handler();
    }
}

void operator delete(void* place) noexcept {
    std::free(place);
}

void operator delete(void* place, std::size_t) noexcept {
    std::free(place);
}
