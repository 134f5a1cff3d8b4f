// Calls something every second, also in a hidden tab: browsers slow the timers of such pages down to one a minute, but
// not those of workers. Somebody who waits in another tab must not count as away.
import { transport } from '../shared/transport';

interface Policies {
  createPolicy: (name: string, rules: { createScriptURL: (text: string) => string }) => { createScriptURL: (text: string) => string };
}

function makeWorker(): Worker {
  const address = '/assets/live/worker.js';
  const { trustedTypes } = window as { trustedTypes?: Policies };
  const policy = trustedTypes?.createPolicy('kith-worker', { createScriptURL: () => address });
  return new Worker(policy ? policy.createScriptURL(address) : address);
}

export function everySecond(call: () => void): void {
  const byTimer = (): void => void setInterval(call, 1000);
  if (transport().isLocal) return byTimer(); // nobody waits for the person
  try {
    const worker = makeWorker();
    worker.onmessage = call;
    worker.onerror = () => {
      worker.terminate();
      byTimer();
    };
  } catch {
    byTimer();
  }
}
