// The optional name, which only the organiser sees.
import type { JSX } from 'preact';
import { useState } from 'preact/hooks';
import type { ScreenProps } from '../screen';
import { keep, recall } from '../storage';
import { t } from '../texts';

export function Name({ view, connection }: Pick<ScreenProps, 'view' | 'connection'>): JSX.Element {
  const [name, setName] = useState(() => recall<string>('name') ?? '');
  const [sent, setSent] = useState<string | null>(null);
  const isSaved = sent !== null && !connection.isPending('name');
  return (
    <form
      class="name"
      onSubmit={(event) => {
        event.preventDefault();
        connection.send('name', { name: name.trim() });
        setSent(name.trim());
        keep('name', name.trim());
      }}
    >
      <label for="name">{t('person.label')}</label>
      <p id="name-help" class="muted">
        {t('person.help', { label: view.me.label })}
      </p>
      <div class="buttons">
        <input
          id="name"
          type="text"
          maxLength={80}
          autocomplete="off"
          aria-describedby="name-help"
          value={name}
          onInput={(event) => setName(event.currentTarget.value)}
        />
        <button type="submit" class="plain">
          {t('person.save')}
        </button>
      </div>
      <p role="status">{isSaved && t('person.saved', { name: sent })}</p>
    </form>
  );
}
