// Messages that the server has not acknowledged yet, in order. They survive a reload.
import type { Message } from './protocol';
import { keep, recall } from './storage';

export class Outbox {
  private messages: Message[];

  // `owner` is the token: a tab that becomes another person's must not send the first one's messages.
  constructor(private readonly owner: string) {
    const kept = recall<{ owner: string; messages: Message[] }>('outbox');
    this.messages = kept?.owner === owner && Array.isArray(kept.messages) ? kept.messages : [];
  }

  all(): readonly Message[] {
    return this.messages;
  }

  add(message: Message): void {
    this.messages = [...this.messages, message];
    this.save();
  }

  remove(id: string): Message | undefined {
    const found = this.messages.find((message) => message.id === id);
    if (found) {
      this.messages = this.messages.filter((message) => message.id !== id);
      this.save();
    }
    return found;
  }

  private save(): void {
    keep('outbox', { owner: this.owner, messages: this.messages });
  }
}
