// Printed by the tests of libs/live from the members of its events and views: do not edit (docs/live-protocol.md).
export interface RoomCommands {
  start: Record<string, never>;
  pause: Record<string, never>;
  resume: Record<string, never>;
  extend: { seconds: number };
  message: { text: string; seat?: number | null };
  readmit: { seat: number };
  simulate: { seat: number; type?: string };
  strategy: { name: string };
  end: Record<string, never>;
}

