// Called for objects with thread storage. They live as long as the module, which has one thread.
extern "C" int __cxa_thread_atexit(void (*)(void*), void*, void*) noexcept { return 0; }
