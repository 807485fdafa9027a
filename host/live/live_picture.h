// Somewhere to see a picture while it is rendered.
#pragma once

#include "film.h"
#include "tone_map.h"

namespace vkvol {

class LivePicture {
public:
    virtual ~LivePicture() = default;
    // The film as far as it is; `mapping` where eyes need one. What no longer takes pictures ignores them.
    virtual void show(const Film& film, const ToneMapping& mapping) = 0;
    // Why it takes no more, to be told once; empty as long as it does.
    virtual std::string failure() const { return ""; }
};

} // namespace vkvol
