// A Vulkan driver of which one function fails; the rest is the driver at REAL.

#include <dlfcn.h>
#include <string.h>

typedef void (*Function)(void);
typedef Function (*Lookup)(void *, const char *);

static Function real(const char *name) {
    static void *library;
    if (!library) library = dlopen(REAL, RTLD_NOW | RTLD_LOCAL);
    return library ? (Function)dlsym(library, name) : 0;
}

static int fail(void) { return RESULT; }

static Lookup device_lookup;

static Function in_device(void *device, const char *name) {
    return strcmp(name, FAILS) ? device_lookup(device, name) : (Function)fail;
}

Function vk_icdGetInstanceProcAddr(void *instance, const char *name) {
    Function found = ((Lookup)real("vk_icdGetInstanceProcAddr"))(instance, name);
    if (found && !strcmp(name, FAILS)) return (Function)fail;
    if (found && !strcmp(name, "vkGetDeviceProcAddr")) {
        device_lookup = (Lookup)found;
        return (Function)in_device;
    }
    return found;
}

int vk_icdNegotiateLoaderICDInterfaceVersion(unsigned *version) {
    return ((int (*)(unsigned *))real("vk_icdNegotiateLoaderICDInterfaceVersion"))(version);
}

Function vk_icdGetPhysicalDeviceProcAddr(void *instance, const char *name) {
    Lookup lookup = (Lookup)real("vk_icdGetPhysicalDeviceProcAddr");
    return lookup ? lookup(instance, name) : 0;
}
