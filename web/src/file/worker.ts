// Runs the engine beside the page: the first message is the WebAssembly, packed, every other a request, answered by a
// reply.
import { expanded } from './packed';

interface Module {
  _kith_engine: (request: number) => number;
  _malloc: (size: number) => number;
  _free: (address: number) => void;
  UTF8ToString: (address: number) => string;
  stringToUTF8: (text: string, address: number, size: number) => void;
  lengthBytesUTF8: (text: string) => number;
}
declare const createKithEngine: (options: { wasmBinary: Uint8Array }) => Promise<Module>;

const answerPage = postMessage as (message: unknown) => void;
let engine: Promise<Module> | null = null;

function answer(module: Module, request: string): string {
  const size = module.lengthBytesUTF8(request) + 1;
  const address = module._malloc(size);
  module.stringToUTF8(request, address, size);
  const reply = module.UTF8ToString(module._kith_engine(address));
  module._free(address);
  return reply;
}

onmessage = ({ data }: MessageEvent<Uint8Array | string>) => {
  if (typeof data !== 'string') {
    engine = createKithEngine({ wasmBinary: expanded(data) });
    return;
  }
  void engine?.then(
    (module) => {
      try {
        answerPage(answer(module, data));
      } catch (error) {
        answerPage(JSON.stringify({ error: String(error) }));
      }
    },
    (error: unknown) => answerPage(JSON.stringify({ error: String(error) })),
  );
};
