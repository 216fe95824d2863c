/** The functions of WASI that the module imports. It does not use files; time is for its statistics. */
export function wasi(compiled, memory) {
  const unsupported = 52;  // ENOSYS
  const functions = {
    clock_time_get(_clock, _precision, result) {
      const nanoseconds = BigInt(Math.round(performance.now() * 1e6));
      new DataView(memory().buffer).setBigUint64(result, nanoseconds, true);
      return 0;
    },
    environ_sizes_get(count, size) {
      const view = new DataView(memory().buffer);
      view.setUint32(count, 0, true);
      view.setUint32(size, 0, true);
      return 0;
    },
    environ_get: () => 0,
    proc_exit(code) {
      throw new Error(`the module ended with status ${code}`);
    },
  };
  const result = {};
  for (const {module, name} of WebAssembly.Module.imports(compiled))
    (result[module] ??= {})[name] = functions[name] ?? (() => unsupported);
  return result;
}
