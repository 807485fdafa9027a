// A Vulkan layer for tests: the n-th call of one function fails, as it would on a machine in trouble.
//
//   VK_LAYER_PATH=<directory of the manifest>  VK_INSTANCE_LAYERS=VK_LAYER_VKVOL_fault
//   VKVOL_FAULT=vkWaitForFences:7:VK_ERROR_DEVICE_LOST   the 7th call fails; a device lost stays lost
//   VKVOL_FAULT_COUNTS=FILE                              as the device is destroyed: every function with its number of
//   calls VKVOL_FAULT_CACHE_BYTES=N                            pipeline caches grow by N bytes (software drivers keep
//   none)
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>
#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

namespace {

// Functions that can fail, all of them returning VkResult. The device's come second.
#define INSTANCE_FUNCTIONS(X)                                                                                          \
    X(vkEnumeratePhysicalDevices)                                                                                      \
    X(vkCreateDevice)
#define DEVICE_FUNCTIONS(X)                                                                                            \
    X(vkQueueSubmit)                                                                                                   \
    X(vkWaitForFences)                                                                                                 \
    X(vkResetFences)                                                                                                   \
    X(vkAllocateMemory)                                                                                                \
    X(vkMapMemory)                                                                                                     \
    X(vkCreateBuffer)                                                                                                  \
    X(vkBindBufferMemory)                                                                                              \
    X(vkCreateShaderModule)                                                                                            \
    X(vkCreatePipelineCache)                                                                                           \
    X(vkGetPipelineCacheData)                                                                                          \
    X(vkCreateComputePipelines)                                                                                        \
    X(vkCreateDescriptorSetLayout)                                                                                     \
    X(vkCreatePipelineLayout)                                                                                          \
    X(vkCreateDescriptorPool)                                                                                          \
    X(vkAllocateDescriptorSets)                                                                                        \
    X(vkCreateCommandPool)                                                                                             \
    X(vkAllocateCommandBuffers)                                                                                        \
    X(vkBeginCommandBuffer)                                                                                            \
    X(vkEndCommandBuffer)                                                                                              \
    X(vkCreateFence)                                                                                                   \
    X(vkCreateQueryPool)                                                                                               \
    X(vkGetQueryPoolResults)

#define NUMBER(function) number_##function,
enum Function { INSTANCE_FUNCTIONS(NUMBER) DEVICE_FUNCTIONS(NUMBER) number_vkCreateInstance, function_count };
#define NAME(function) #function,
constexpr const char* names[] = {INSTANCE_FUNCTIONS(NAME) DEVICE_FUNCTIONS(NAME) "vkCreateInstance"};

struct Result {
    const char* name;
    VkResult value;
};
constexpr Result results[] = {{"VK_ERROR_DEVICE_LOST", VK_ERROR_DEVICE_LOST},
                              {"VK_ERROR_OUT_OF_HOST_MEMORY", VK_ERROR_OUT_OF_HOST_MEMORY},
                              {"VK_ERROR_OUT_OF_DEVICE_MEMORY", VK_ERROR_OUT_OF_DEVICE_MEMORY},
                              {"VK_ERROR_OUT_OF_POOL_MEMORY", VK_ERROR_OUT_OF_POOL_MEMORY},
                              {"VK_ERROR_MEMORY_MAP_FAILED", VK_ERROR_MEMORY_MAP_FAILED},
                              {"VK_ERROR_INITIALIZATION_FAILED", VK_ERROR_INITIALIZATION_FAILED}};

// A wrong test is no test: what cannot be understood ends the process.
[[noreturn]] void refuse(const char* text) {
    std::fprintf(stderr, "fault layer: VKVOL_FAULT=%s: expected FUNCTION:NUMBER:VK_ERROR_...\n", text);
    std::abort();
}

template <class Predicate> int find(int count, const Predicate& fits) {
    for (int i = 0; i < count; ++i)
        if (fits(i))
            return i;
    return -1;
}

// What is to fail, and how often each function was called.
class Plan {
public:
    Plan() {
        const char* text = std::getenv("VKVOL_FAULT");
        if (!text)
            return;
        char function[64], result[64];
        if (std::sscanf(text, "%63[^:]:%d:%63s", function, &number_, result) != 3)
            refuse(text);
        function_ = find(function_count, [&](int i) { return std::strcmp(names[i], function) == 0; });
        const int found = find(std::size(results), [&](int i) { return std::strcmp(results[i].name, result) == 0; });
        if (function_ < 0 || found < 0)
            refuse(text);
        result_ = results[found].value;
    }

    void write_counts() const {
        const char* name = std::getenv("VKVOL_FAULT_COUNTS");
        std::FILE* file = name ? std::fopen(name, "w") : nullptr;
        if (!file)
            return;
        for (int i = 0; i < function_count; ++i)
            std::fprintf(file, "%s %d\n", names[i], calls_[i].load());
        std::fclose(file);
    }

    // What this call is to return instead of being made; VK_SUCCESS: let it be made.
    VkResult next(int function) {
        if (++calls_[function] == number_ && function == function_)
            lost_ = result_ == VK_ERROR_DEVICE_LOST;
        else if (!(lost_ && (function == number_vkQueueSubmit || function == number_vkWaitForFences)))
            return VK_SUCCESS;
        return result_;
    }

private:
    std::atomic<int> calls_[function_count]{};
    int function_ = -1, number_ = 0;
    VkResult result_ = VK_SUCCESS;
    std::atomic<bool> lost_ = false;
};

Plan plan;
PFN_vkGetInstanceProcAddr next_instance_function = nullptr;
PFN_vkGetDeviceProcAddr next_device_function = nullptr;
VkInstance the_instance = VK_NULL_HANDLE;

template <int number, class Pointer> struct Hook;
template <int number, class... Arguments> struct Hook<number, VkResult (*)(Arguments...)> {
    static inline VkResult (*next)(Arguments...) = nullptr;
    static VkResult call(Arguments... arguments) {
        const VkResult fault = plan.next(number);
        // A lost device has ended what it did: nothing that it used may be destroyed before.
        if (fault == VK_SUCCESS || number == number_vkWaitForFences) {
            const VkResult result = next(arguments...);
            return fault == VK_SUCCESS ? result : fault;
        }
        return fault;
    }
};
#define HOOK(function) Hook<number_##function, PFN_##function>

VkResult create_device(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                       const VkAllocationCallbacks* allocator, VkDevice* device) {
    if (const VkResult fault = plan.next(number_vkCreateDevice); fault != VK_SUCCESS)
        return fault;
    auto* link = reinterpret_cast<VkLayerDeviceCreateInfo*>(const_cast<void*>(info->pNext));
    while (link->sType != VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO || link->function != VK_LAYER_LINK_INFO)
        link = reinterpret_cast<VkLayerDeviceCreateInfo*>(const_cast<void*>(link->pNext));
    const VkLayerDeviceLink* layer = link->u.pLayerInfo;
    link->u.pLayerInfo = layer->pNext;
    next_device_function = layer->pfnNextGetDeviceProcAddr;
    const auto create =
        reinterpret_cast<PFN_vkCreateDevice>(layer->pfnNextGetInstanceProcAddr(the_instance, "vkCreateDevice"));
    const VkResult result = create(physical, info, allocator, device);
    if (result == VK_SUCCESS) {
#define FIND_DEVICE(function)                                                                                          \
    HOOK(function)::next = reinterpret_cast<PFN_##function>(next_device_function(*device, #function));
        DEVICE_FUNCTIONS(FIND_DEVICE)
    }
    return result;
}

VkResult create_instance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocator,
                         VkInstance* instance) {
    if (const VkResult fault = plan.next(number_vkCreateInstance); fault != VK_SUCCESS)
        return fault;
    auto* link = reinterpret_cast<VkLayerInstanceCreateInfo*>(const_cast<void*>(info->pNext));
    while (link->sType != VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO || link->function != VK_LAYER_LINK_INFO)
        link = reinterpret_cast<VkLayerInstanceCreateInfo*>(const_cast<void*>(link->pNext));
    next_instance_function = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const auto create = reinterpret_cast<PFN_vkCreateInstance>(next_instance_function(nullptr, "vkCreateInstance"));
    const VkResult result = create(info, allocator, instance);
    if (result == VK_SUCCESS) {
        the_instance = *instance;
#define FIND_INSTANCE(function)                                                                                        \
    HOOK(function)::next = reinterpret_cast<PFN_##function>(next_instance_function(*instance, #function));
        INSTANCE_FUNCTIONS(FIND_INSTANCE)
    }
    return result;
}

std::size_t cache_growth() {
    const char* bytes = std::getenv("VKVOL_FAULT_CACHE_BYTES");
    return bytes ? std::strtoull(bytes, nullptr, 10) : 0;
}

VkResult get_cache_data(VkDevice device, VkPipelineCache cache, std::size_t* size, void* data) {
    const std::size_t growth = cache_growth();
    std::size_t own = data && *size > growth ? *size - growth : 0;
    const VkResult result = HOOK(vkGetPipelineCacheData)::call(device, cache, &own, data);
    if (data && growth)
        std::memset(static_cast<char*>(data) + own, 'x', growth);
    *size = own + growth;
    return result;
}

VkResult create_cache(VkDevice device, const VkPipelineCacheCreateInfo* info, const VkAllocationCallbacks* allocator,
                      VkPipelineCache* cache) {
    VkPipelineCacheCreateInfo own = *info;
    own.initialDataSize -= own.initialDataSize > cache_growth() ? cache_growth() : 0;
    return HOOK(vkCreatePipelineCache)::call(device, &own, allocator, cache);
}

void destroy_device(VkDevice device, const VkAllocationCallbacks* allocator) {
    plan.write_counts();
    reinterpret_cast<PFN_vkDestroyDevice>(next_device_function(device, "vkDestroyDevice"))(device, allocator);
}

PFN_vkVoidFunction get_device_function(VkDevice device, const char* name);
PFN_vkVoidFunction get_instance_function(VkInstance instance, const char* name);

struct Entry {
    const char* name;
    PFN_vkVoidFunction function;
};
template <class Pointer> Entry entry(const char* name, Pointer function) {
    return {name, reinterpret_cast<PFN_vkVoidFunction>(function)};
}

PFN_vkVoidFunction own_device_function(const char* name) {
#define ENTRY(function) entry(#function, &HOOK(function)::call),
    static const Entry entries[] = {entry("vkGetDeviceProcAddr", get_device_function),
                                    entry("vkDestroyDevice", destroy_device),
                                    entry("vkGetPipelineCacheData", get_cache_data),
                                    entry("vkCreatePipelineCache", create_cache), DEVICE_FUNCTIONS(ENTRY)};
    const int found = find(std::size(entries), [&](int i) { return std::strcmp(entries[i].name, name) == 0; });
    return found < 0 ? nullptr : entries[found].function;
}

PFN_vkVoidFunction get_device_function(VkDevice device, const char* name) {
    const PFN_vkVoidFunction own = own_device_function(name);
    return own ? own : next_device_function(device, name);
}

PFN_vkVoidFunction get_instance_function(VkInstance instance, const char* name) {
    static const Entry entries[] = {entry("vkGetInstanceProcAddr", get_instance_function),
                                    entry("vkCreateInstance", create_instance), entry("vkCreateDevice", create_device),

                                    entry("vkEnumeratePhysicalDevices", &HOOK(vkEnumeratePhysicalDevices)::call)};
    const int found = find(std::size(entries), [&](int i) { return std::strcmp(entries[i].name, name) == 0; });
    if (found >= 0)
        return entries[found].function;
    if (const PFN_vkVoidFunction own = own_device_function(name))
        return own;
    return instance ? next_instance_function(instance, name) : nullptr;
}

} // namespace

extern "C" __attribute__((visibility("default"))) VkResult
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* layer) {
    layer->loaderLayerInterfaceVersion = CURRENT_LOADER_LAYER_INTERFACE_VERSION;
    layer->pfnGetInstanceProcAddr = get_instance_function;
    layer->pfnGetDeviceProcAddr = get_device_function;
    layer->pfnGetPhysicalDeviceProcAddr = nullptr;
    return VK_SUCCESS;
}
