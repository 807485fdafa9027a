// An array that its copies share: what a thousand media have in common lies in memory once.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace vkvol {

template <class T> class SharedArray {
public:
    SharedArray() = default;
    explicit SharedArray(std::size_t size) : values_(std::make_shared<std::vector<T>>(size)) {}
    SharedArray(std::vector<T> values) : values_(std::make_shared<std::vector<T>>(std::move(values))) {}

    // The same for all copies, and for no other array as long as one of them is there; null if there is nothing in it.
    const T* data() const { return values_ && !values_->empty() ? values_->data() : nullptr; }
    std::size_t size() const { return values_ ? values_->size() : 0; }
    bool empty() const { return size() == 0; }
    const T* begin() const { return data(); }
    const T* end() const { return data() + size(); }
    const T& operator[](std::size_t i) const { return (*values_)[i]; }
    operator std::span<const T>() const { return {data(), size()}; }

    // To be written to. What copies share is copied first, and stays as it is for them.
    T* edit() {
        if (values_ && values_.use_count() > 1)
            values_ = std::make_shared<std::vector<T>>(*values_);
        return values_ ? values_->data() : nullptr;
    }

private:
    std::shared_ptr<std::vector<T>> values_;
};

} // namespace vkvol
