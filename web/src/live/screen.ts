// What every screen is given.
import type { Connection } from './connection';
import type { ParticipantView } from './protocol';

export interface ScreenProps {
  view: ParticipantView;
  connection: Connection;
  token: string;
}
