/* Preloaded: below $NO_SHARED_MEMORY files cannot be mapped as shared memory, as on many shares. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

typedef void *map(void *, size_t, int, int, int, off_t);

static int refused(int flags, int file) {
  const char *below = getenv("NO_SHARED_MEMORY");
  char link[64], path[4096];
  if (!below || file < 0 || !(flags & MAP_SHARED)) return 0;
  snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  ssize_t length = readlink(link, path, sizeof path - 1);
  if (length < 0) return 0;
  path[length] = 0;
  return strncmp(path, below, strlen(below)) == 0;
}

static void *map_with(const char *name, void *at, size_t size, int protection, int flags, int file, off_t from) {
  if (refused(flags, file)) {
    errno = ENODEV;
    return MAP_FAILED;
  }
  return ((map *)dlsym(RTLD_NEXT, name))(at, size, protection, flags, file, from);
}

void *mmap(void *at, size_t size, int protection, int flags, int file, off_t from) {
  return map_with("mmap", at, size, protection, flags, file, from);
}

void *mmap64(void *at, size_t size, int protection, int flags, int file, off_t from) {
  return map_with("mmap64", at, size, protection, flags, file, from);
}
